// A confined process touches what it was given, and nothing else.
#include "gap/challenge/confinement.hpp"

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <functional>

#include "tests/formats/runs/temporary_folder.hpp"

using namespace kenaf;
using gap::challenge::Confinement;
using test::TemporaryFolder;
using test::write_file;

namespace {

// Whether `attempt` succeeds in a process that is confined.
bool confined(const Confinement& confinement, const std::function<bool()>& attempt) {
  const pid_t process = ::fork();
  if (process == 0) ::_exit(confinement.enter() ? (attempt() ? 0 : 1) : 2);
  int status = 0;
  REQUIRE(::waitpid(process, &status, 0) == process);
  REQUIRE(WIFEXITED(status));
  REQUIRE(WEXITSTATUS(status) != 2);
  return WEXITSTATUS(status) == 0;
}

bool opens(const std::filesystem::path& path, int flags) {
  const int file = ::open(path.c_str(), flags, 0644);
  if (file >= 0) ::close(file);
  return file >= 0;
}

}  // namespace

TEST_CASE("A confined process reads its case and writes its report, but reads no key and no memory of others") {
  if (!gap::challenge::can_confine()) {
    WARN("skipped: this kernel has no Landlock");
    return;
  }
  const TemporaryFolder folder;
  for (const char* name : {"case", "other", "report"}) {
    std::filesystem::create_directory(folder / name);
    write_file(folder / name / "file", "x");
  }
  write_file(folder / "key.json", "{}");
  const Confinement confinement({folder / "case", folder / "not-there"}, {folder / "report"});
  REQUIRE(confinement.confines());

  CHECK(confined(confinement, [&] { return opens(folder / "case" / "file", O_RDONLY); }));
  CHECK(confined(confinement, [&] { return opens(folder / "report" / "new", O_WRONLY | O_CREAT); }));
  CHECK(std::filesystem::exists(folder / "report" / "new"));

  CHECK_FALSE(confined(confinement, [&] { return opens(folder / "case" / "file", O_WRONLY); }));
  CHECK_FALSE(confined(confinement, [&] { return opens(folder / "case" / "new", O_WRONLY | O_CREAT); }));
  CHECK_FALSE(confined(confinement, [&] { return opens(folder / "other" / "file", O_RDONLY); }));
  CHECK_FALSE(confined(confinement, [&] { return opens(folder / "key.json", O_RDONLY); }));
  CHECK_FALSE(confined(confinement, [&] { return opens(folder.path(), O_RDONLY | O_DIRECTORY); }));
  const std::string parent = "/proc/" + std::to_string(::getpid());
  CHECK_FALSE(confined(confinement, [&] { return opens(parent + "/mem", O_RDONLY); }));
  CHECK_FALSE(confined(confinement, [&] { return opens(parent + "/cmdline", O_RDONLY); }));
  CHECK(opens(folder / "key.json", O_RDONLY));  // who is not confined can
}
