#include "formats/ply_header.h"

#include <algorithm>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>

#include "formats/scalar_common.h"
#include "formats/wording.h"

namespace bspc::formats {

namespace {

std::optional<ScalarType> typeFromName(std::string_view name) {
  constexpr std::array<std::pair<std::string_view, ScalarType>, 18> kTypes{{
      {"char", ScalarType::Int8},
      {"int8", ScalarType::Int8},
      {"uchar", ScalarType::UInt8},
      {"uint8", ScalarType::UInt8},
      {"short", ScalarType::Int16},
      {"int16", ScalarType::Int16},
      {"ushort", ScalarType::UInt16},
      {"uint16", ScalarType::UInt16},
      {"int", ScalarType::Int32},
      {"int32", ScalarType::Int32},
      {"uint", ScalarType::UInt32},
      {"uint32", ScalarType::UInt32},
      {"float", ScalarType::Float32},
      {"float32", ScalarType::Float32},
      {"double", ScalarType::Float64},
      {"float64", ScalarType::Float64},
      {"int64", ScalarType::Int64},
      {"uint64", ScalarType::UInt64},
  }};
  for (const auto& [known, type] : kTypes) {
    if (known == name) return type;
  }
  return std::nullopt;
}

class HeaderReader {
 public:
  explicit HeaderReader(TextScanner& text) : text_(text) {}

  PlyHeader read() {
    std::string_view word;
    if (!text_.nextLine()) text_.fail("the file is empty; expected \"ply\"");
    if (!text_.nextToken(word) || word != "ply") {
      text_.fail("not a PLY file: expected \"ply\", found " + quoted(word));
    }
    requireLineEnd();
    while (readLine()) {
    }
    if (!hasFormat_) text_.fail("the header has no line \"format\"");
    findPositions();
    findArrays();
    return std::move(header_);
  }

 private:
  /// False at end_header.
  bool readLine() {
    if (!text_.nextLine()) {
      text_.failAtEnd("the file ends inside the header; expected \"end_header\"");
    }
    std::string_view word;
    if (!text_.nextToken(word)) return true;
    if (word == "comment" || word == "obj_info") {
      (word == "comment" ? header_.comments : header_.infos).emplace_back(text_.rest());
      return true;
    }
    if (word == "format") {
      readFormat();
    } else if (word == "element") {
      readElement();
    } else if (word == "property") {
      readProperty();
    } else if (word != "end_header") {
      text_.fail(
          "expected \"format\", \"element\", \"property\", \"comment\" or \"end_header\", "
          "found " +
          quoted(word));
    }
    const bool more = word != "end_header";
    requireLineEnd();
    return more;
  }

  std::string_view expectWord(const char* what) {
    std::string_view word;
    if (!text_.nextToken(word)) text_.fail(std::string("expected ") + what);
    return word;
  }

  void requireLineEnd() {
    std::string_view word;
    if (text_.nextToken(word)) text_.fail("expected the end of the line, found " + quoted(word));
  }

  void readFormat() {
    if (hasFormat_) text_.fail("a second line \"format\"");
    const std::string_view name = expectWord("the format: ascii or binary_little_endian ...");
    if (name == "ascii") {
      header_.encoding = PlyEncoding::Ascii;
    } else if (name == "binary_little_endian") {
      header_.encoding = PlyEncoding::LittleEndian;
    } else if (name == "binary_big_endian") {
      header_.encoding = PlyEncoding::BigEndian;
    } else {
      text_.fail("expected ascii, binary_little_endian or binary_big_endian, found " +
                 quoted(name));
    }
    const std::string_view version = expectWord("the version 1.0");
    if (version != "1.0") text_.fail("expected version 1.0, found " + quoted(version));
    hasFormat_ = true;
  }

  void readElement() {
    PlyElement element;
    element.name = expectWord("the name of an element");
    if (!elementNames_.insert(element.name).second) {
      text_.fail("a second element " + quoted(element.name));
    }
    propertyNames_.clear();
    element.count = text_.number<std::uint64_t>(expectWord("the number of elements"), [&] {
      return "the number of elements " + quoted(element.name);
    });
    header_.elements.push_back(std::move(element));
  }

  ScalarType expectType() {
    const std::string_view name = expectWord("a type such as float or uchar");
    const std::optional<ScalarType> type = typeFromName(name);
    if (!type) text_.fail("expected a type such as float or uchar, found " + quoted(name));
    return *type;
  }

  void readProperty() {
    if (header_.elements.empty()) text_.fail("a property before the first element");
    PlyProperty property;
    std::string_view word = expectWord("a type or \"list\"");
    if (word == "list") {
      property.isList = true;
      property.countType = expectType();
      if (isFloatingPoint(property.countType)) {
        text_.fail("the number of items of a list must be of an integer type");
      }
      property.type = expectType();
    } else {
      const std::optional<ScalarType> type = typeFromName(word);
      if (!type) text_.fail("expected \"list\" or a type such as float, found " + quoted(word));
      property.type = *type;
    }
    property.name = expectWord("the name of the property");
    if (!propertyNames_.insert(property.name).second) {
      text_.fail("a second property " + quoted(property.name));
    }
    header_.elements.back().properties.push_back(std::move(property));
  }

  void findPositions() {
    const auto& elements = header_.elements;
    const auto vertex = std::find_if(elements.begin(), elements.end(),
                                     [](const PlyElement& e) { return e.name == "vertex"; });
    if (vertex == elements.end()) text_.fail("the header declares no element \"vertex\"");
    header_.vertexElement = static_cast<std::size_t>(vertex - elements.begin());
    std::array<ScalarType, 3> types{};
    for (std::size_t k = 0; k < 3; ++k) {
      const std::string name(1, "xyz"[k]);
      const auto& properties = vertex->properties;
      const auto found = std::find_if(properties.begin(), properties.end(),
                                      [&](const PlyProperty& p) { return p.name == name; });
      if (found == properties.end()) {
        text_.fail("the element \"vertex\" has no property " + quoted(name));
      }
      if (found->isList) {
        text_.fail("the vertex property " + quoted(name) + " is a list; expected a number");
      }
      header_.xyz[k] = static_cast<std::size_t>(found - properties.begin());
      types[k] = found->type;
    }
    header_.positionType = commonScalarType(types);
  }

  void findArrays() {
    const std::vector<PlyProperty>& properties = header_.vertices().properties;
    std::vector<Column> columns;
    std::vector<std::size_t> propertyOf;
    for (std::size_t p = 0; p < properties.size(); ++p) {
      const bool isPosition =
          std::find(header_.xyz.begin(), header_.xyz.end(), p) != header_.xyz.end();
      if (isPosition || properties[p].isList) continue;
      columns.push_back({utf8(properties[p].name), properties[p].type});
      propertyOf.push_back(p);
    }
    header_.arrays = groupColumns(columns);
    for (GroupedColumns& group : header_.arrays) {
      for (std::size_t& column : group.columns) column = propertyOf[column];
    }
  }

  TextScanner& text_;
  PlyHeader header_;
  std::set<std::string> elementNames_;
  std::set<std::string> propertyNames_;  ///< of the last element
  bool hasFormat_ = false;
};

}  // namespace

bool PlyElement::hasList() const {
  return std::any_of(properties.begin(), properties.end(),
                     [](const PlyProperty& p) { return p.isList; });
}

std::uint64_t PlyElement::fixedBytes() const {
  std::uint64_t bytes = 0;
  for (const PlyProperty& p : properties) bytes += p.isList ? 0 : scalarSize(p.type);
  return bytes;
}

std::uint64_t PlyElement::leastBytes(PlyEncoding encoding) const {
  // In text, a digit and a blank a number.
  if (encoding == PlyEncoding::Ascii) return 2 * properties.size();
  std::uint64_t bytes = fixedBytes();
  for (const PlyProperty& p : properties) bytes += p.isList ? scalarSize(p.countType) : 0;
  return bytes;
}

PlyHeader readPlyHeader(TextScanner& text) { return HeaderReader(text).read(); }

std::optional<std::size_t> plyFaceList(const PlyElement& element) {
  if (element.name != "face") return std::nullopt;
  for (std::size_t p = 0; p < element.properties.size(); ++p) {
    const PlyProperty& property = element.properties[p];
    if (property.isList && (property.name == "vertex_indices" || property.name == "vertex_index")) {
      return p;
    }
  }
  return std::nullopt;
}

std::vector<OtherContent> otherPlyContent(const PlyHeader& header, bool keepsFaces) {
  std::vector<OtherContent> content;
  for (std::size_t e = 0; e < header.elements.size(); ++e) {
    const PlyElement& element = header.elements[e];
    if (element.count == 0) continue;
    const std::optional<std::size_t> faces = plyFaceList(element);
    if (keepsFaces && faces) {
      for (std::size_t p = 0; p < element.properties.size(); ++p) {
        if (p == *faces) continue;
        content.push_back(
            {"face property " + quoted(element.properties[p].name), OtherContent::Kind::Rest});
      }
      continue;
    }
    if (e != header.vertexElement) {
      const bool plain = element.name == "face" || element.name == "edge";
      const std::string name = plain ? element.name : quoted(element.name) + " element";
      const bool connects = plain || element.name == "tristrips";
      content.push_back({counted(element.count, name, name + "s"),
                         connects ? OtherContent::Kind::Connectivity : OtherContent::Kind::Rest});
      continue;
    }
    for (const PlyProperty& property : element.properties) {
      if (!property.isList) continue;
      content.push_back({"vertex property " + quoted(property.name) + " (list of " +
                             scalarName(property.type) + ")",
                         OtherContent::Kind::Rest});
    }
  }
  return content;
}

}  // namespace bspc::formats
