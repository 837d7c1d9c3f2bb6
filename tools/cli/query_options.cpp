#include "cli/query_options.h"

#include <array>
#include <string_view>

#include "cli/usage_error.h"
#include "formats/number_text.h"

namespace bspc::cli {

namespace {

Box parseBox(const std::string& text) {
  std::array<double, 6> numbers{};
  std::string_view left = text;
  std::size_t count = 0;
  for (bool more = true; more; ++count) {
    const std::size_t comma = left.find(',');
    more = comma != std::string_view::npos;
    if (count == numbers.size() ||
        formats::parseNumber(left.substr(0, comma), numbers[count]) != formats::NumberStatus::Ok) {
      count = 0;
      break;
    }
    if (more) left.remove_prefix(comma + 1);
  }
  if (count != numbers.size()) {
    throw UsageError("--box takes six numbers, x0,y0,z0,x1,y1,z1, unlike \"" + text + "\"");
  }
  Box box;
  for (std::size_t k = 0; k < 3; ++k) {
    box.lower[k] = numbers[k];
    box.upper[k] = numbers[k + 3];
    if (!(box.lower[k] <= box.upper[k])) {
      throw UsageError("--box takes the lower corner first; " + std::string(1, "xyz"[k]) +
                       " goes down in \"" + text + "\"");
    }
  }
  return box;
}

}  // namespace

void addQueryOptions(CLI::App& command, QueryArguments& args) {
  constexpr auto kGroup = "Part of the file";
  command.add_option("--level", args.level, "Layers 0 to LEVEL only")
      ->option_text("LEVEL")
      ->group(kGroup);
  command
      .add_option("--max-points", args.maxPoints,
                  "At most so many points: the finest level that fits")
      ->option_text("N")
      ->group(kGroup);
  command
      .add_option("--box", args.box,
                  "Only points in this box, faces included, in units of the data")
      ->option_text("x0,y0,z0,x1,y1,z1")
      ->group(kGroup);
}

DecodeOptions decodeOptions(const QueryArguments& args) {
  DecodeOptions options;
  options.level = args.level;
  options.maxPoints = args.maxPoints;
  if (!args.box.empty()) options.box = parseBox(args.box);
  return options;
}

}  // namespace bspc::cli
