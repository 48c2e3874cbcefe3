// What a reader sends to the image server, in pieces, and the parts of a picture that it asks for. Invariants: nothing
// dies, however the bytes are split the requests are the same, and a part is never larger than the picture.
#include <cstdlib>
#include <string_view>
#include <vector>

#include "server/image_server/image_request.hpp"
#include "server/image_server/raw_picture.hpp"

using namespace kenaf::image_server;

namespace {

std::vector<ImageRequest> requests_in(std::string_view bytes, std::size_t piece) {
  ImageRequestParser parser;
  std::vector<ImageRequest> out;
  while (!bytes.empty()) {
    std::string_view sent = bytes.substr(0, piece);
    bytes.remove_prefix(sent.size());
    while (const auto request = parser.take(sent)) out.push_back(*request);
  }
  return out;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const std::string_view bytes(reinterpret_cast<const char*>(data) + 1, size - 1);
  const auto whole = requests_in(bytes, bytes.size() + 1), pieces = requests_in(bytes, std::size_t{1} + data[0] % 32);
  if (whole.size() != pieces.size()) std::abort();
  static const kenaf::camera::Picture picture{19, 7, std::vector<std::uint8_t>(3 * 19 * 7)};
  for (std::size_t i = 0; i < whole.size(); ++i) {
    const ImageRequest &a = whole[i], &b = pieces[i];
    if (a.kind != b.kind || a.view != b.view || a.x != b.x || a.y != b.y || a.width != b.width ||
        a.height != b.height) {
      std::abort();
    }
    if (a.view.size() > 255) std::abort();
    if (raw_picture(picture, a.x, a.y, a.width, a.height).size() > 4 + 60 * 7) std::abort();
  }
  return 0;
}
