#include "server/image_server/image_request.hpp"

#include <catch2/catch.hpp>
#include <vector>

#include "tests/server/image_server/image_client.hpp"

namespace kenaf::image_server {

namespace {

using Kind = ImageRequest::Kind;

// Each request with the view it shows, sent in pieces of `piece` bytes: "p:" for OK, "j:" and "u:" likewise.
std::vector<std::string> requests(std::string_view bytes, std::size_t piece) {
  ImageRequestParser parser;
  std::vector<std::string> out;
  while (!bytes.empty()) {
    std::string_view sent = bytes.substr(0, piece);
    bytes.remove_prefix(sent.size());
    while (const auto request = parser.take(sent)) {
      out.push_back((request->kind == Kind::picture ? "p:"
                     : request->kind == Kind::jpeg  ? "j:"
                                                    : "u:") +
                    request->view);
    }
  }
  return out;
}

}  // namespace

TEST_CASE("Requests are found however they are split, and what is none is skipped") {
  const std::string part = part_request(1, 2, 3, 4);
  const std::string bytes =
      "OK"
      "OK\r\n"
      "garbage OOK KO " +
      part + view_request("R1/Camera") + "OK" + part + "J" + view_request("") + "OK" + view_request("OKJU") + "\r\nJ";
  for (const std::size_t piece : {1u, 2u, 3u, 7u, 1000u}) {
    CHECK(requests(bytes, piece) == std::vector<std::string>{"p:", "p:", "p:", "u:", "p:R1/Camera", "u:R1/Camera",
                                                             "j:R1/Camera", "p:", "j:OKJU"});
  }
}

TEST_CASE("A part's numbers are big-endian, whatever they are") {
  ImageRequestParser parser;
  const std::string text = part_request(0x01020304, 0xffffffff, 0, 0x80000000);
  std::string_view bytes = text;
  const auto request = parser.take(bytes);
  REQUIRE(request);
  CHECK(request->x == 0x01020304);
  CHECK(request->y == 0xffffffff);
  CHECK(request->width == 0);
  CHECK(request->height == 0x80000000);
}

}  // namespace kenaf::image_server
