#include "cli/array_choice.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "cli/text.h"
#include "cli/usage_error.h"
#include "formats/number_text.h"

namespace bspc::cli {

namespace {

std::string namesOf(const std::vector<ArrayDescription>& arrays) {
  if (arrays.empty()) return "it has none";
  constexpr std::size_t kShown = 20;
  std::string names = "it has ";
  for (std::size_t a = 0; a < arrays.size() && a < kShown; ++a) {
    names += (a > 0 ? ", " : "") + oneLine(arrays[a].name, 40);
  }
  return names + (arrays.size() > kShown ? ", ..." : "");
}

std::size_t indexOf(const std::string& name, const std::vector<ArrayDescription>& arrays) {
  for (std::size_t a = 0; a < arrays.size(); ++a) {
    if (arrays[a].name == name) return a;
  }
  for (const ArrayDescription& array : arrays) {
    const auto& parts = array.componentNames;
    if (std::find(parts.begin(), parts.end(), name) == parts.end()) continue;
    throw UsageError("\"" + name + "\" is a component of the array " + oneLine(array.name, 40) +
                     "; name that one");
  }
  throw UsageError("the model has no array \"" + name + "\"; " + namesOf(arrays));
}

void setTolerance(const std::string& wish, std::vector<ArrayDescription>& arrays) {
  const std::size_t sign = wish.rfind('=');
  double tolerance = 0;
  const bool isGood =
      sign != std::string::npos &&
      formats::parseNumber(wish.substr(sign + 1), tolerance) == formats::NumberStatus::Ok &&
      std::isfinite(tolerance) && tolerance > 0;
  if (!isGood) {
    throw UsageError("--array-precision takes NAME=TOLERANCE, such as Normals=0.5, unlike \"" +
                     wish + "\"");
  }
  ArrayDescription& array = arrays[indexOf(wish.substr(0, sign), arrays)];
  if (!isFloatingPoint(array.type)) {
    throw UsageError("--array-precision is for floating-point arrays; " + array.name + " is of " +
                     scalarName(array.type));
  }
  array.tolerance = tolerance;
}

}  // namespace

std::vector<std::string> splitNames(const std::string& list) {
  std::vector<std::string> names;
  for (std::size_t at = 0; at <= list.size();) {
    const std::size_t end = std::min(list.find(',', at), list.size());
    const std::size_t first = std::min(list.find_first_not_of(' ', at), end);
    const std::size_t last = list.find_last_not_of(' ', end == 0 ? 0 : end - 1);
    if (first < end) names.push_back(list.substr(first, last + 1 - first));
    at = end + 1;
  }
  return names;
}

std::vector<std::size_t> chooseArrays(const ArrayArguments& args,
                                      std::vector<ArrayDescription>& arrays) {
  std::vector<bool> chosen(arrays.size(), !args.arrays);
  if (args.arrays) {
    for (const std::string& name : splitNames(*args.arrays)) chosen[indexOf(name, arrays)] = true;
  }
  for (const std::string& name : args.without) chosen[indexOf(name, arrays)] = false;
  for (const std::string& wish : args.precisions) setTolerance(wish, arrays);
  std::vector<std::size_t> kept;
  for (std::size_t a = 0; a < arrays.size(); ++a) {
    if (chosen[a]) kept.push_back(a);
  }
  return kept;
}

}  // namespace bspc::cli
