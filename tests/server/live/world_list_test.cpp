// The list of installed worlds, and the command that starts the server with one of them.
#include "server/live/world_list.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>
#include <string>

#include "tests/server/live/served_world.hpp"
#include "tests/server/live/web_client.hpp"

namespace kenaf::live {

TEST_CASE("A world's words are the first comment of its file, in one line and of limited length") {
  CHECK(first_comment("<?xml version=\"1.0\"?>\n<!-- A step of\n     200 mm.\t-->\n<sdf><!-- not this --></sdf>") ==
        "A step of 200 mm.");
  CHECK(first_comment("<sdf/>").empty());
  CHECK(first_comment("<!---->").empty());
  CHECK(first_comment("<!-- cut off by the").starts_with("cut off"));
  const std::string words = first_comment("<!-- " + std::string(200, 'a') + " " + std::string(200, 'b') + " -->");
  CHECK(words == std::string(200, 'a'));  // whole words, 300 bytes
}

TEST_CASE("The command names the view's address unless it is the usual one") {
  CHECK(start_command(ViewOptions{}, 8080) == "kenaf-world --world WORLD");
  CHECK(start_command(ViewOptions{}, 8081) == "kenaf-world --world WORLD --view 127.0.0.1:8081");
  ViewOptions anywhere;
  anywhere.address = "::";
  anywhere.token = "secret";  // which the page, and whoever looks at it, is not told
  anywhere.program = "kenaf-relayd --embedded";
  CHECK(start_command(anywhere, 8080) == "kenaf-relayd --embedded --world WORLD --view [::]:8080");
}

TEST_CASE("The server lists the installed worlds, to who has the token") {
  ServedWorld world("sesame");
  const auto answer_to = [&](std::string_view target) {
    WebClient client(world.port());
    client.send(get(target));
    return client.answer();
  };
  CHECK(answer_to("/worlds").starts_with("HTTP/1.1 401"));
  CHECK(answer_to("/worlds/stairs?token=sesame").starts_with("HTTP/1.1 404"));
  const std::string answer = answer_to("/worlds?token=sesame");
  REQUIRE(answer.starts_with("HTTP/1.1 200"));
  const auto list = nlohmann::json::parse(answer.substr(answer.find("\r\n\r\n") + 4));
  CHECK(list["command"] == "kenaf-world --world WORLD --view 127.0.0.1:" + std::to_string(world.port()));
  const auto& worlds = list["worlds"];
  const auto stairs =
      std::find_if(worlds.begin(), worlds.end(), [](const auto& each) { return each["name"] == "stairs"; });
  REQUIRE(stairs != worlds.end());
  CHECK((*stairs)["words"] ==
        "12 steps of 75 mm rise and 175 mm run from x = 1 m on, 2 m wide, then a landing of 2 m.");
}

}  // namespace kenaf::live
