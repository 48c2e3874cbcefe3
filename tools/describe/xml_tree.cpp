#include "tools/describe/xml_tree.hpp"

#include <expat.h>
#include <fmt/format.h>

#include <cctype>
#include <charconv>
#include <cmath>
#include <memory>

#include "physics/xml_line.hpp"

namespace kenaf::describe {
namespace {

constexpr std::size_t kMostBytes = std::size_t{8} << 20;
constexpr std::size_t kMostNested = 50;
constexpr std::size_t kMostElements = 100'000;
constexpr std::size_t kMostAttributes = 100;
constexpr std::string_view kBlanks = " \t\r\n";

// The elements that are open, outermost first; each moves into the one around it when it ends.
struct Builder {
  XML_Parser parser;
  std::vector<XmlNode> open;
  XmlNode root;
  std::size_t elements = 0;
  std::string refusal;

  void refuse(std::string why) {
    if (refusal.empty()) refusal = std::move(why);
    XML_StopParser(parser, XML_FALSE);
  }
};

void on_start(void* user, const XML_Char* name, const XML_Char** attributes) {
  Builder& builder = *static_cast<Builder*>(user);
  if (builder.open.size() == kMostNested)
    return builder.refuse(fmt::format("elements are nested more than {} deep", kMostNested));
  if (++builder.elements > kMostElements)
    return builder.refuse(fmt::format("there are more than {} elements", kMostElements));
  XmlNode node;
  node.name = name;
  node.line = physics::line_of(builder.parser);
  for (; *attributes; attributes += 2) node.attributes.emplace(attributes[0], attributes[1]);
  if (node.attributes.size() > kMostAttributes)
    return builder.refuse(fmt::format("an element has more than {} attributes", kMostAttributes));
  builder.open.push_back(std::move(node));
}

void on_end(void* user, const XML_Char*) {
  Builder& builder = *static_cast<Builder*>(user);
  XmlNode node = std::move(builder.open.back());
  builder.open.pop_back();
  if (builder.open.empty())
    builder.root = std::move(node);
  else
    builder.open.back().children.push_back(std::move(node));
}

void on_text(void* user, const XML_Char* text, int length) {
  Builder& builder = *static_cast<Builder*>(user);
  if (!builder.open.empty()) builder.open.back().text.append(text, static_cast<std::size_t>(length));
}

void on_document_type(void* user, const XML_Char*, const XML_Char*, const XML_Char*, int) {
  static_cast<Builder*>(user)->refuse("a document type is not supported; leave out the <!DOCTYPE>");
}

void on_declaration(void* user, const XML_Char*, const XML_Char* encoding, int) {
  if (!encoding) return;
  std::string name = encoding;
  for (char& c : name) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  if (name != "utf-8" && name != "us-ascii")
    static_cast<Builder*>(user)->refuse(fmt::format("the encoding is {}; save the file as UTF-8", encoding));
}

}  // namespace

const std::string* XmlNode::attribute(const std::string& key) const {
  const auto found = attributes.find(key);
  return found == attributes.end() ? nullptr : &found->second;
}

const XmlNode* XmlNode::child(std::string_view child_name) const {
  for (const XmlNode& node : children)
    if (node.name == child_name) return &node;
  return nullptr;
}

const XmlNode* XmlNode::below(std::string_view path) const {
  const XmlNode* node = this;
  while (node && !path.empty()) {
    const std::size_t slash = path.find('/');
    node = node->child(path.substr(0, slash));
    path = slash == std::string_view::npos ? std::string_view() : path.substr(slash + 1);
  }
  return node;
}

XmlNode parse_xml(std::string_view text, const std::string& file) {
  using description::DescriptionError;
  // Refuses bytes that Expat would take for another encoding, or another reader for the end.
  if (text.size() > kMostBytes)
    throw DescriptionError(fmt::format("{}: is larger than the {} MiB that are read", file, kMostBytes >> 20));
  if (text.find('\0') != std::string_view::npos)
    throw DescriptionError(fmt::format("{}: holds a zero byte: it is no text in UTF-8", file));

  const std::unique_ptr<XML_ParserStruct, decltype(&XML_ParserFree)> parser(XML_ParserCreate(nullptr), XML_ParserFree);
  Builder builder{.parser = parser.get(), .open = {}, .root = {}, .refusal = {}};
  XML_SetUserData(parser.get(), &builder);
  XML_SetElementHandler(parser.get(), on_start, on_end);
  XML_SetCharacterDataHandler(parser.get(), on_text);
  XML_SetStartDoctypeDeclHandler(parser.get(), on_document_type);
  XML_SetXmlDeclHandler(parser.get(), on_declaration);
  if (XML_Parse(parser.get(), text.data(), static_cast<int>(text.size()), 1) == XML_STATUS_OK &&
      builder.refusal.empty())
    return std::move(builder.root);
  const std::string why = builder.refusal.empty() ? fmt::format("is not well-formed XML: {}",
                                                                XML_ErrorString(XML_GetErrorCode(parser.get())))
                                                  : builder.refusal;
  throw DescriptionError(fmt::format("{}:{}: {}", file, physics::line_of(parser.get()), why));
}

std::optional<std::vector<double>> numbers_in(std::string_view text) {
  std::vector<double> numbers;
  while (true) {
    const std::size_t first = text.find_first_not_of(kBlanks);
    if (first == std::string_view::npos) return numbers;
    text.remove_prefix(first);
    std::string_view word = text.substr(0, text.find_first_of(kBlanks));
    text.remove_prefix(word.size());
    if (word.starts_with('+')) word.remove_prefix(1);
    double number = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
    if (error != std::errc() || end != word.data() + word.size() || !std::isfinite(number)) return std::nullopt;
    numbers.push_back(number);
  }
}

std::string xml_escaped(std::string_view text) {
  std::string escaped;
  for (const char c : text) {
    switch (c) {
      case '&':
        escaped += "&amp;";
        break;
      case '<':
        escaped += "&lt;";
        break;
      case '>':
        escaped += "&gt;";
        break;
      case '"':
        escaped += "&quot;";
        break;
      default:
        escaped += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
    }
  }
  return escaped;
}

}  // namespace kenaf::describe
