#include "formats/pcd_writer.h"

#include <algorithm>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "formats/array_columns.h"
#include "formats/las_records.h"
#include "formats/number_text.h"
#include "formats/pcd_arrays.h"
#include "formats/record_writer.h"
#include "formats/wording.h"

namespace bspc::formats {

namespace {

/// A column of the header.
struct Field {
  std::string name;
  std::size_t size = 0;
  char type = 'F';
  std::size_t count = 1;
};

char letterOf(ScalarType type) {
  if (isFloatingPoint(type)) return 'F';
  const bool isSigned = type == ScalarType::Int8 || type == ScalarType::Int16 ||
                        type == ScalarType::Int32 || type == ScalarType::Int64;
  return isSigned ? 'I' : 'U';
}

class PcdWriter : public PointWriter {
 public:
  explicit PcdWriter(const ModelLayout& layout) : layout_(layout) {
    requireNumbers(layout.arrays, "a PCD file");
    for (std::size_t k = 0; k < 3; ++k) {
      addField(std::string(1, "xyz"[k]), layout.type, 1);
      addNumbers(RecordField::kPosition, {k}, layout.type);
    }
    findColours();
    for (std::size_t a = 0; a < layout.arrays.size(); ++a) addArray(a);
    chooseRows();
  }

  void begin(OutputBuffer& out) override {
    std::string& text = out.text();
    text += "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS";
    for (const Field& field : fields_) text += ' ' + field.name;
    text += "\nSIZE";
    for (const Field& field : fields_) text += ' ' + std::to_string(field.size);
    text += "\nTYPE";
    for (const Field& field : fields_) text += std::string(" ") + field.type;
    text += "\nCOUNT";
    for (const Field& field : fields_) text += ' ' + std::to_string(field.count);
    const std::string viewpoint = metadataEntry(layout_.metadata, "pcd.viewpoint");
    text += "\nWIDTH " + std::to_string(width_) + "\nHEIGHT " + std::to_string(height_) +
            "\nVIEWPOINT " + (viewpoint.empty() ? "0 0 0 1 0 0 0" : wordsOf(viewpoint)) +
            "\nPOINTS " + std::to_string(layout_.points) + "\nDATA binary\n";
  }

  void append(OutputBuffer& out, const PointSetView& points) override {
    writeRecords(out, points, numbers_, recordBytes_, "a PCD file");
  }

 private:
  static std::string wordsOf(std::string text) {
    std::replace_if(
        text.begin(), text.end(), [](char c) { return c < ' '; }, ' ');
    return text;
  }

  void addField(const std::string& name, ScalarType type, std::size_t count) {
    const std::string word = wordOf(name);
    if (!names_.insert(word).second) {
      throw FormatError("two fields of the PCD file would be called " + quoted(word) +
                        "; leave one of the arrays out");
    }
    fields_.push_back({word, scalarSize(type), letterOf(type), count});
  }

  /// Components of an array, one behind the other.
  void addNumbers(std::size_t array, const std::vector<std::size_t>& components, ScalarType type) {
    for (const std::size_t component : components) {
      numbers_.push_back({fields_.back().name, array, component, type, recordBytes_});
      recordBytes_ += scalarSize(type);
    }
  }

  /// Colours of bytes, the first with three and the first with four.
  void findColours() {
    const auto& arrays = layout_.arrays;
    for (std::size_t a = 0; a < arrays.size(); ++a) {
      if (arrays[a].type != ScalarType::UInt8) continue;
      const bool isColour = arrays[a].semantic == Semantic::Colours;
      if (isColour && arrays[a].components == 3 && rgb_ == kNone) rgb_ = a;
      if (isColour && arrays[a].components == 4 && rgba_ == kNone) rgba_ = a;
      if (arrays[a].name == kPcdColourPadding && arrays[a].components == 1) padding_ = a;
    }
  }

  void addArray(std::size_t index) {
    const ArrayDescription& array = layout_.arrays[index];
    const ScalarType type = array.type == ScalarType::Bit ? ScalarType::UInt8 : array.type;
    if (index == rgb_ || index == rgba_) return addPackedColour(index);
    if (index == padding_ && rgb_ != kNone) return;
    std::vector<std::string> names = namesOfComponents(array);
    if (array.semantic == Semantic::Normals && !names.empty() && names[0] == "nx") {
      names = {"normal_x", "normal_y", "normal_z"};
    }
    for (std::size_t k = 0; k < names.size(); ++k) {
      addField(names[k], type, 1);
      addNumbers(index, {k}, type);
    }
    if (!names.empty()) return;
    std::vector<std::size_t> components(array.components);
    for (std::size_t k = 0; k < components.size(); ++k) components[k] = k;
    addField(array.name, type, array.components);
    addNumbers(index, components, type);
  }

  /// Blue comes first, as in the lowest byte of a number.
  void addPackedColour(std::size_t index) {
    const std::string name = index == rgb_ ? "rgb" : "rgba";
    const std::string kept = metadataEntry(layout_.metadata, "pcd." + name);
    ScalarType type = index == rgb_ ? ScalarType::Float32 : ScalarType::UInt32;
    for (const ScalarType known : {ScalarType::Float32, ScalarType::UInt32, ScalarType::Int32}) {
      if (kept == scalarName(known)) type = known;
    }
    addField(name, type, 1);
    addNumbers(index, {2, 1, 0}, ScalarType::UInt8);
    if (index == rgba_) {
      addNumbers(index, {3}, ScalarType::UInt8);
    } else if (padding_ != kNone) {
      addNumbers(padding_, {0}, ScalarType::UInt8);
    } else {
      ++recordBytes_;
    }
  }

  void chooseRows() {
    width_ = layout_.points;
    if (!layout_.keepsOrder) return;
    std::uint64_t width = 0;
    std::uint64_t height = 0;
    const auto entry = [&](const char* key, std::uint64_t& value) {
      const std::string text = metadataEntry(layout_.metadata, key);
      return parseNumber(text, value) == NumberStatus::Ok && value > 0;
    };
    if (!entry("pcd.width", width) || !entry("pcd.height", height)) return;
    if (layout_.points / width != height || layout_.points % width != 0) return;
    width_ = width;
    height_ = height;
  }

  static constexpr std::size_t kNone = SIZE_MAX - 1;

  ModelLayout layout_;
  std::vector<Field> fields_;
  std::set<std::string> names_;
  std::vector<RecordField> numbers_;
  std::size_t recordBytes_ = 0;
  std::size_t rgb_ = kNone;
  std::size_t rgba_ = kNone;
  std::size_t padding_ = kNone;
  std::uint64_t width_ = 0;
  std::uint64_t height_ = 1;
};

}  // namespace

std::unique_ptr<PointWriter> pcdWriter(const ModelLayout& layout) {
  return std::make_unique<PcdWriter>(layout);
}

}  // namespace bspc::formats
