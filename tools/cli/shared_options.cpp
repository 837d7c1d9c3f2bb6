#include "cli/shared_options.h"

#include <array>
#include <cmath>
#include <string_view>

#include "cli/input_file.h"
#include "cli/naming.h"
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

std::string positiveNumber(const std::string& text) {
  double value = 0;
  const bool good = CLI::detail::lexical_cast(text, value) && std::isfinite(value) && value > 0;
  return good ? std::string() : "must be a finite number above 0";
}

GridRequest gridRequest(const SourceArguments& args) {
  const int wishes = (args.bits != 0 ? 1 : 0) + (args.precision != 0 ? 1 : 0) +
                     (args.grid != "auto" ? 1 : 0) + (args.exact ? 1 : 0);
  if (wishes > 1) throw UsageError("--bits, --precision, --exact and --grid exclude each other");
  GridRequest request;
  if (args.bits != 0) {
    request = GridRequest::withBits(args.bits);
  } else if (args.precision != 0) {
    request = GridRequest::withPrecision(args.precision);
  } else if (args.exact) {
    request = GridRequest::exactFloats();
  } else if (args.grid != "auto") {
    InputFile file(args.grid);
    request = naming(file.name(),
                     [&file] { return GridRequest::onGrid(Decoder(file.source()).info().grid); });
  }
  request.dropNonFinite = args.dropNonFinite;
  return request;
}

bool keepsOrder(const SourceArguments& args, const formats::ModelInfo& info) {
  if (args.keepOrder && args.anyOrder) {
    throw UsageError("--keep-order and --any-order exclude each other");
  }
  if (args.keepOrder || args.anyOrder) return args.keepOrder;
  return info.isOrganised && !args.content.positionsOnly && !args.dropNonFinite;
}

void addGridOptions(CLI::App& command, SourceArguments& args) {
  constexpr auto kGroup = "Grid";
  command
      .add_option("--bits", args.bits,
                  "Quantise: the largest extent spans 2^BITS - 1 steps (1 to 32)")
      ->option_text("BITS")
      ->check(CLI::Range(1U, 32U))
      ->group(kGroup);
  command
      .add_option("--precision", args.precision,
                  "Quantise: step in units of the data; the error is at most half of it")
      ->check(positiveNumber)
      ->type_name("STEP")
      ->group(kGroup);
  command
      .add_flag("--exact", args.exact,
                "Keep every bit of floating-point coordinates, also where they lie\n"
                "on no lattice")
      ->group(kGroup);
  command
      .add_option("--grid", args.grid,
                  "auto (the default) finds the lattice that the points\n"
                  "lie on and keeps them exactly, else to float precision;\n"
                  "FILE.bspc takes that file's, so that neighbours meet")
      ->type_name("auto|FILE.bspc")
      ->group(kGroup);
}

void addContentOptions(CLI::App& command, SourceArguments& args) {
  constexpr auto kGroup = "Content";
  ContentArguments& content = args.content;
  command
      .add_option("--arrays", content.arrays.arrays, "Keep these arrays only; `info` lists names")
      ->option_text("NAME,...")
      ->group(kGroup);
  command.add_option("--no-array", content.arrays.without, "Leave out an array (may be repeated)")
      ->option_text("NAME")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
      ->group(kGroup);
  command
      .add_option("--array-precision", content.arrays.precisions,
                  "Let values of a floating-point array differ by at most\n"
                  "TOL, normals by TOL degrees (may be repeated)")
      ->option_text("NAME=TOL")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
      ->group(kGroup);
  command
      .add_flag("--positions-only", content.positionsOnly, "Leave out everything but the positions")
      ->group(kGroup);
  command.add_flag("--no-faces", content.noFaces, "Leave out faces and edges")->group(kGroup);
  command
      .add_flag("--drop-other", content.dropOther,
                "Leave out whatever a .bspc file cannot hold, such as lists")
      ->group(kGroup);
  command
      .add_flag("--drop-nonfinite", args.dropNonFinite,
                "Leave out points with NaN or infinite coordinates")
      ->group(kGroup);
  command
      .add_flag("--keep-order", args.keepOrder,
                "Keep the order of the points (the default for rows of a PCD file)")
      ->group(kGroup);
  command.add_flag("--any-order", args.anyOrder, "Do not keep it")->group(kGroup);
  command
      .add_flag("--original-ids", args.originalIds,
                "Add the array OriginalPointIds: where in the input each point was")
      ->group(kGroup);
  command.add_option("--crs", content.crs, "The coordinate reference system, as WKT or EPSG:25832")
      ->option_text("TEXT")
      ->group(kGroup);
}

void addFromOption(CLI::App& command, SourceArguments& args) {
  command.add_option("--from", args.from, "Format of the input where its name does not tell")
      ->type_name("ply|obj|off|xyz|csv|las|pcd");
}

}  // namespace bspc::cli
