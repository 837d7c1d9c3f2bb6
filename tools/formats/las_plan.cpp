#include "formats/las_plan.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <map>
#include <optional>
#include <sstream>
#include <utility>

#include "formats/array_columns.h"
#include "formats/las_records.h"
#include "formats/number_text.h"
#include "formats/record_writer.h"
#include "formats/wording.h"

namespace bspc::formats {

namespace {

constexpr std::size_t kNone = SIZE_MAX;

bool isColour(const ArrayDescription& array) {
  const bool isWhole = array.type == ScalarType::UInt8 || array.type == ScalarType::UInt16;
  return array.semantic == Semantic::Colours && array.components == 3 && isWhole;
}

/// Whether the array can fill the field.
bool fills(const ArrayDescription& array, const LasField& field) {
  if (field.array.semantic == Semantic::Colours) return isColour(array);
  const bool isFlag = field.bits == 1 && array.type == ScalarType::Bit;
  return array.name == field.array.name && array.components == field.array.components &&
         (array.type == field.array.type || isFlag);
}

std::vector<LasFilledField> filledFields(unsigned pointFormat,
                                         const std::vector<ArrayDescription>& arrays) {
  std::vector<LasFilledField> filled;
  for (LasField& field : lasFields(pointFormat)) {
    const auto found = std::find_if(arrays.begin(), arrays.end(),
                                    [&](const ArrayDescription& a) { return fills(a, field); });
    if (found == arrays.end()) continue;
    const bool isByte = found->type == ScalarType::UInt8 && field.array.type == ScalarType::UInt16;
    filled.push_back(
        {std::move(field), static_cast<std::size_t>(found - arrays.begin()), isByte ? 256U : 1U});
  }
  return filled;
}

std::optional<unsigned> numberOf(const Metadata& metadata, const char* key) {
  unsigned number = 0;
  const std::string text = metadataEntry(metadata, key);
  if (parseNumber(text, number) != NumberStatus::Ok) return std::nullopt;
  return number;
}

unsigned choosePointFormat(const ModelLayout& layout) {
  std::vector<unsigned> candidates{6, 7, 8, 9, 10, 0, 1, 2, 3, 4, 5};
  const std::optional<unsigned> kept = numberOf(layout.metadata, "las.point_format");
  if (kept && *kept < kLasPointFormats) candidates.insert(candidates.begin(), *kept);
  unsigned best = candidates.front();
  std::size_t most = filledFields(best, layout.arrays).size();
  for (const unsigned candidate : candidates) {
    const std::size_t filled = filledFields(candidate, layout.arrays).size();
    if (filled <= most) continue;
    best = candidate;
    most = filled;
  }
  return best;
}

unsigned chooseVersion(const ModelLayout& layout, unsigned pointFormat) {
  unsigned least = pointFormat >= 6 ? 4 : (pointFormat >= 4 ? 3 : 2);
  if (layout.points > std::numeric_limits<std::uint32_t>::max()) least = 4;
  const std::string kept = metadataEntry(layout.metadata, "las.version");
  for (unsigned minor = least; minor <= 4; ++minor) {
    if (kept == "1." + std::to_string(minor)) return minor;
  }
  return least;
}

std::optional<std::array<double, 3>> threeNumbers(const Metadata& metadata, const char* key) {
  std::istringstream text(metadataEntry(metadata, key));
  std::array<double, 3> numbers{};
  std::string word;
  for (double& number : numbers) {
    const bool isNumber = (text >> word) && parseNumber(word, number) == NumberStatus::Ok;
    if (!isNumber || !std::isfinite(number)) return std::nullopt;
  }
  return numbers;
}

/// Whether the box fits into 32 bits; without a box nobody knows, and points will tell.
bool fitsBounds(const ModelLayout& layout, std::size_t axis, double scale, double offset) {
  if (!std::isfinite(scale) || scale == 0 || !std::isfinite(offset)) return false;
  if (!layout.bounds) return true;
  for (const std::array<double, 3>& corner : *layout.bounds) {
    const double x = (corner[axis] - offset) / scale;
    if (!(std::fabs(x) < 2147483647.0)) return false;
  }
  return true;
}

bool takeKept(const ModelLayout& layout, LasPlan& plan) {
  const auto scale = threeNumbers(layout.metadata, "las.scale");
  const auto offset = threeNumbers(layout.metadata, "las.offset");
  if (!scale || !offset) return false;
  for (std::size_t k = 0; k < 3; ++k) {
    if (!fitsBounds(layout, k, (*scale)[k], (*offset)[k])) return false;
  }
  plan.scale = *scale;
  plan.offset = *offset;
  return true;
}

bool takeLattice(const ModelLayout& layout, LasPlan& plan) {
  if (!layout.lattice) return false;
  const Grid& grid = *layout.lattice;
  for (std::size_t k = 0; k < 3; ++k) {
    const int axis = static_cast<int>(k);
    plan.scale[k] = grid.step(axis);
    const double middle =
        grid.coordinateOfMultiple(axis, grid.axes[k].base + (std::int64_t{1} << 31));
    bool found = false;
    for (const double offset : {grid.coordinateOfMultiple(axis, 0), middle}) {
      if (found || !fitsBounds(layout, k, plan.scale[k], offset)) continue;
      plan.offset[k] = offset;
      found = true;
    }
    if (!found) return false;
  }
  return true;
}

/// A decimal scale, the finest with which the box fits into 32 bits, but no finer than doubles are.
void takeBounds(const ModelLayout& layout, LasPlan& plan) {
  for (std::size_t k = 0; k < 3; ++k) {
    const double low = layout.bounds ? (*layout.bounds)[0][k] : 0;
    const double high = layout.bounds ? (*layout.bounds)[1][k] : 1e6;
    const double greatest = std::max({std::fabs(low), std::fabs(high), 1e-290});
    int exponent = static_cast<int>(std::floor(std::log10(greatest * 1e-15)));
    while (exponent < 300 && (high - low) / std::pow(10.0, exponent) > 2e9) ++exponent;
    plan.scale[k] = std::pow(10.0, exponent);
    plan.offset[k] = std::floor(low + (high - low) / 2);
    if (!fitsBounds(layout, k, plan.scale[k], plan.offset[k])) plan.offset[k] = low;
  }
}

class ExtraPlanner {
 public:
  ExtraPlanner(const ModelLayout& layout, LasPlan& plan) : layout_(layout), plan_(plan) {
    for (const LasRecord& record : lasRecordsOf(layout.metadata)) {
      if (record.is(kLasSpecification, kLasExtraDescriptions)) keepDescriptions(record.payload);
    }
  }

  void run() {
    std::vector<bool> used(layout_.arrays.size());
    for (const LasFilledField& field : plan_.fields) used[field.array] = true;
    std::vector<ArrayDescription> left;
    std::vector<std::size_t> indexOf;
    std::size_t rest = kNone;
    for (std::size_t a = 0; a < layout_.arrays.size(); ++a) {
      const ArrayDescription& array = layout_.arrays[a];
      if (used[a]) continue;
      if (array.name == kLasExtraBytes && array.type == ScalarType::UInt8) {
        rest = a;
      } else if (isDescribedWhole(array)) {
        describe(kept_.at(array.name));
        addNumbers(a, array);
      } else {
        left.push_back(array);
        indexOf.push_back(a);
      }
    }
    for (const ArrayColumn& column : columnsOf(left)) {
      describeNumber(column.name, column.type);
      add(column.name, column.type, indexOf[column.array], column.component);
    }
    if (rest != kNone) addNumbers(rest, layout_.arrays[rest]);
  }

 private:
  void keepDescriptions(const Bytes& descriptions) {
    for (std::size_t at = 0; descriptions.size() - at >= kLasExtraDescription;
         at += kLasExtraDescription) {
      const auto first = descriptions.begin() + static_cast<std::ptrdiff_t>(at);
      Bytes one(first, first + static_cast<std::ptrdiff_t>(kLasExtraDescription));
      const auto fields = lasExtraFields(one, UINT16_MAX);
      if (fields.front().bytes == UINT16_MAX) continue;
      kept_.emplace(fields.front().array.name, std::move(one));
    }
  }

  /// Whether the array came out of one description and fits it still.
  bool isDescribedWhole(const ArrayDescription& array) const {
    const auto found = kept_.find(array.name);
    if (found == kept_.end()) return false;
    const LasExtraField field = lasExtraFields(found->second, UINT16_MAX).front();
    return field.array.type == array.type && field.array.components == array.components;
  }

  void describe(const Bytes& description) {
    Bytes& all = plan_.extraDescriptions;
    all.insert(all.end(), description.begin(), description.end());
  }

  /// As an earlier description has it if that is of this type, else anew.
  void describeNumber(const std::string& name, ScalarType type) {
    const auto found = kept_.find(name);
    if (found != kept_.end() && found->second[2] == lasExtraType(type)) {
      return describe(found->second);
    }
    if (name.size() > 32) {
      throw FormatError("the array " + quoted(name) +
                        " has a name of more than the 32 bytes that a LAS file has for it");
    }
    Bytes description(kLasExtraDescription);
    description[2] = static_cast<std::uint8_t>(lasExtraType(type));
    std::copy(name.begin(), name.end(), description.begin() + 4);
    describe(description);
  }

  void addNumbers(std::size_t index, const ArrayDescription& array) {
    for (std::size_t k = 0; k < array.components; ++k) add(array.name, array.type, index, k);
  }

  void add(const std::string& name, ScalarType type, std::size_t array, std::size_t component) {
    plan_.extras.push_back({name, type, array, component, plan_.recordBytes});
    plan_.recordBytes += scalarSize(type);
  }

  const ModelLayout& layout_;
  LasPlan& plan_;
  /// Descriptions that the metadata keep, by name.
  std::map<std::string, Bytes> kept_;
};

}  // namespace

LasPlan planLas(const ModelLayout& layout) {
  requireNumbers(layout.arrays, "a LAS file");
  LasPlan plan;
  plan.pointFormat = choosePointFormat(layout);
  plan.minorVersion = chooseVersion(layout, plan.pointFormat);
  plan.fields = filledFields(plan.pointFormat, layout.arrays);
  plan.recordBytes = lasRecordBytes(plan.pointFormat);
  ExtraPlanner(layout, plan).run();
  if (plan.recordBytes > UINT16_MAX || plan.extraDescriptions.size() > UINT16_MAX) {
    throw FormatError("the arrays are too many for the extra bytes of a LAS file; leave some out");
  }
  if (!takeKept(layout, plan) && !takeLattice(layout, plan)) takeBounds(layout, plan);
  return plan;
}

}  // namespace bspc::formats
