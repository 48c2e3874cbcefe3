#include "relayd/address_lookup.hpp"

#include <netinet/in.h>

#include <atomic>
#include <catch2/catch.hpp>
#include <future>
#include <memory>
#include <stdexcept>

#include "relayd/mailbox.hpp"
#include "tests/relayd/allocations.hpp"

using namespace kenaf::relayd;
using namespace std::chrono_literals;

namespace {

// A name server that does not answer before it is released.
struct SilentServer {
  std::promise<std::vector<Endpoint>> says;
  std::shared_future<std::vector<Endpoint>> said = says.get_future().share();
  std::shared_ptr<std::atomic<int>> asked = std::make_shared<std::atomic<int>>(0);

  AddressLookup lookup() const {
    return AddressLookup([said = said, asked = asked](const kenaf::protocol::HostPort&) {
      kenaf::test::leave_this_thread_out();
      ++*asked;
      return said.get();
    });
  }
};

auto now() {
  return std::chrono::steady_clock::now();
}

}  // namespace

TEST_CASE("A look-up that takes for ever ends when it is cancelled, and at its deadline") {
  SilentServer names;
  AddressLookup lookup = names.lookup();
  const kenaf::protocol::HostPort server{"world.example", 3000};
  Waker cancel;
  CHECK_THROWS_WITH(lookup.find(server, now() + 20ms, cancel.fd()), Catch::Contains("name"));
  cancel.wake();
  CHECK_FALSE(lookup.find(server, now() + 1h, cancel.fd()));
  cancel.clear();
  // It is the same look-up, and its answer is used when it comes.
  names.says.set_value({Endpoint{}, Endpoint{}});
  const auto found = lookup.find(server, now() + 1h, cancel.fd());
  REQUIRE(found);
  CHECK(found->size() == 2);
  CHECK(*names.asked == 1);
  CHECK(lookup.find(server, now() + 1h, cancel.fd()));  // the next time anew
  CHECK(*names.asked == 2);
}

TEST_CASE("Why a name has no address is said") {
  SilentServer names;
  AddressLookup lookup = names.lookup();
  names.says.set_exception(std::make_exception_ptr(std::runtime_error("there is no such name")));
  const Waker cancel;
  CHECK_THROWS_WITH(lookup.find({"world.example", 3000}, now() + 1h, cancel.fd()), "there is no such name");
}

TEST_CASE("An address in digits is looked up nowhere") {
  const SilentServer names;
  AddressLookup lookup = names.lookup();
  const Waker cancel;
  const auto found = lookup.find({"127.0.0.1", 3000}, now(), cancel.fd());
  REQUIRE(found);
  REQUIRE(found->size() == 1);
  CHECK(found->front().address.ss_family == AF_INET);
  CHECK(ntohs(reinterpret_cast<const sockaddr_in&>(found->front().address).sin_port) == 3000);
  CHECK(lookup.find({"::1", 3000}, now(), cancel.fd())->front().address.ss_family == AF_INET6);
  CHECK(*names.asked == 0);
}
