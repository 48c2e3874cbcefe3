#include "physics/files/sdf_elements.hpp"

#include <fmt/format.h>

#include <map>
#include <memory>
#include <sdf/sdf.hh>
#include <stdexcept>
#include <string>

#include "formats/description/description_error.hpp"
#include "physics/files/sdf_schema.hpp"

namespace kenaf::physics {
namespace {

sdf::ElementPtr empty_document(const std::string& kind) {
  // Made once.
  static const std::map<std::string, sdf::SDFPtr> schemas = [] {
    std::map<std::string, sdf::SDFPtr> made;
    for (const char* each : {"world", "model", "link", "collision", "frame"}) {
      sdf::SDFPtr& schema = made[each];
      schema = std::make_shared<sdf::SDF>();
      if (!sdf::initString(schema_of(each), sdf::ParserConfig(), schema))
        throw std::logic_error("libsdformat does not take the description of worlds");
    }
    return made;
  }();
  return schemas.at(kind)->Root()->Clone();
}

// Returns a copy without descriptions of what else may be in it.
sdf::ElementPtr without_descriptions(const sdf::ElementPtr& element, const SdfPart& part) {
  // Name and place.
  sdf::ElementPtr copy(new sdf::Element);
  copy->SetName(element->GetName() == "inertial" ? kInertialElement : element->GetName());
  copy->SetFilePath(part.file);
  copy->SetOriginalVersion(part.version);
  copy->SetExplicitlySetInFile(element->GetExplicitlySetInFile());
  copy->SetLineNumber(part.line + element->LineNumber().value_or(1) - 1);

  // Attributes, value and elements.
  for (unsigned i = 0; i < element->GetAttributeCount(); ++i) {
    const sdf::ParamPtr given = element->GetAttribute(i);
    copy->AddAttribute(given->GetKey(), given->GetTypeName(), given->GetDefaultAsString(), false);
    *copy->GetAttribute(given->GetKey()) = *given;
  }
  if (const sdf::ParamPtr given = element->GetValue()) {
    copy->AddValue(given->GetTypeName(), given->GetDefaultAsString(), false);
    *copy->GetValue() = *given;
  }
  for (sdf::ElementPtr child = element->GetFirstElement(); child; child = child->GetNextElement()) {
    const sdf::ElementPtr kept = without_descriptions(child, part);
    kept->SetParent(copy);
    copy->InsertElement(kept);
  }
  return copy;
}

}  // namespace

sdf::ElementPtr read_part(const SdfPart& part) {
  // libsdformat reads no file: an outline has no <include>. Into an element, it does not try to read URDF.
  sdf::Console::Instance()->SetQuiet(true);
  const sdf::ElementPtr document = empty_document(part.kind);
  sdf::Errors errors;
  const bool is_read = sdf::readString(part.document, sdf::ParserConfig(), document, errors);
  if (!errors.empty()) {
    const int line = part.line + errors.front().LineNumber().value_or(1) - 1;
    throw description::DescriptionError(fmt::format("{}: {}", place_of(part.file, line), message_of(errors.front())));
  }
  sdf::ElementPtr element = is_read ? document->GetFirstElement() : nullptr;
  if (element && part.kind != "world") element = element->GetFirstElement();
  if (!element) throw description::DescriptionError(fmt::format("{}: cannot be read", place_of(part.file, part.line)));
  return without_descriptions(element, part);
}

sdf::SDFPtr document_of(const sdf::ElementPtr& element) {
  // As libsdformat's own root, whose version it checks.
  sdf::SDFPtr document(new sdf::SDF);
  const sdf::ElementPtr root(new sdf::Element);
  root->SetName("sdf");
  root->AddAttribute("version", "string", SDF_PROTOCOL_VERSION, true);
  root->SetOriginalVersion(element->OriginalVersion());
  element->SetParent(root);
  root->InsertElement(element);
  document->Root(root);
  return document;
}

}  // namespace kenaf::physics
