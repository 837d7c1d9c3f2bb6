#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <iostream>
#include <memory>
#include <numeric>
#include <optional>
#include <utility>
#include <vector>

#include "bspc/decoder.h"
#include "bspc/error.h"
#include "cli/array_comparison.h"
#include "cli/commands.h"
#include "cli/input_file.h"
#include "cli/mesh_comparison.h"
#include "cli/model_files.h"
#include "cli/naming.h"
#include "cli/nearest_distance.h"
#include "cli/progress_bar.h"
#include "cli/restored_points.h"
#include "cli/text.h"
#include "formats/wording.h"

namespace bspc::cli {

namespace {

struct VerifyArguments {
  std::string input;
  std::string against;
  std::string from;
  bool dropNonFinite = false;
  bool lossy = false;
  unsigned threads = 0;
  bool quiet = false;
};

formats::Model readOriginal(const VerifyArguments& args) {
  ProgressBar bar("reading", args.quiet);
  return readModelFile(args.against, args.from, bar.callback());
}

/// Coordinates as an array, where grid points do not tell all their bits.
ArrayValues coordinatesArray(ScalarType type) {
  ArrayValues coordinates;
  coordinates.name = "of coordinates";
  coordinates.type = type;
  coordinates.components = 3;
  return coordinates;
}

/// Everything that the file holds, in its order.
struct Restored {
  explicit Restored(const FileInfo& info) : info_(info) {
    coordinates = coordinatesArray(info.grid.scalarType);
  }

  std::vector<GridPoint> points;
  std::vector<ArrayValues> arrays;
  ArrayValues coordinates;  ///< empty unless the grid is one of the bits of floats
  MeshCells mesh;

  void append(DecodedPoints&& tile) {
    if (info_.grid.form == Grid::Form::FloatBits) {
      const RestoredPoints restored(info_, tile);
      const PointSetView view = restored.view();
      const auto* bytes = static_cast<const std::uint8_t*>(view.data());
      coordinates.values.insert(coordinates.values.end(), bytes,
                                bytes + view.size() * view.strideBytes());
    }
    points.insert(points.end(), tile.points.begin(), tile.points.end());
    if (arrays.empty()) {
      arrays = std::move(tile.arrays);
      return;
    }
    for (std::size_t a = 0; a < arrays.size(); ++a) {
      ArrayValues& to = arrays[a];
      const ArrayValues& from = tile.arrays[a];
      to.values.insert(to.values.end(), from.values.begin(), from.values.end());
      to.strings.insert(to.strings.end(), from.strings.begin(), from.strings.end());
    }
  }

 private:
  const FileInfo& info_;
};

/// A lossy file holds as many points as the original, but not the same.
std::string distanceText(const VerifyArguments& args, const Grid& grid,
                         const std::vector<GridPoint>& points) {
  const formats::Model original = readOriginal(args);
  const PointSetView view = original.view();
  std::vector<std::array<double, 3>> given;
  for (std::uint64_t i = 0; i < view.size(); ++i) {
    const std::array<double, 3> p = view.position(i);
    const bool finite = std::isfinite(p[0]) && std::isfinite(p[1]) && std::isfinite(p[2]);
    if (finite || !args.dropNonFinite) given.push_back(p);
  }
  if (given.size() != points.size()) {
    throw Error(ErrorCode::Corrupt, args.input + ": holds " + withCommas(points.size()) +
                                        " points, and " + args.against + " has " +
                                        withCommas(given.size()));
  }
  if (given.empty()) return ", as many as in " + args.against;
  std::vector<std::array<double, 3>> restored;
  restored.reserve(points.size());
  for (const GridPoint& p : points) {
    restored.push_back({restoredCoordinate(grid, 0, p[0]), restoredCoordinate(grid, 1, p[1]),
                        restoredCoordinate(grid, 2, p[2])});
  }
  return ", as many as in " + args.against + "; no point of it is farther than " +
         shortest(greatestDistanceToNearest(given, std::move(restored))) + " from one of these";
}

[[noreturn]] void failPoints(const VerifyArguments& args, std::uint64_t held, std::uint64_t given,
                             std::uint64_t missing) {
  throw Error(ErrorCode::Corrupt,
              args.input + ": does not hold the points of " + args.against + ": " +
                  withCommas(held) + " points against " + withCommas(given) + ", " +
                  withCommas(missing) +
                  " of the original's are not there; --lossy tells how far the points of a file "
                  "that was coded with lossy stops are");
}

/// Puts the original on the file's grid, counted from the file's own corner, and compares the
/// multisets of grid points.
GridFit fitOriginal(const VerifyArguments& args, const FileInfo& info,
                    const formats::Model& original, std::vector<GridPoint> points) {
  GridRequest request = GridRequest::onGrid(info.grid);
  request.dropNonFinite = args.dropNonFinite;
  GridFit fit = naming(args.against, [&] { return fitGrid(original.view(), request); });
  // The fit counts from the original's own lowest coordinates.
  std::array<std::int64_t, 3> shift{};
  for (std::size_t k = 0; k < 3; ++k) shift[k] = fit.grid.axes[k].base - info.grid.axes[k].base;
  std::uint64_t outside = 0;
  for (GridPoint& p : fit.points) {
    bool inside = true;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::int64_t i = shift[k] + static_cast<std::int64_t>(p[k]);
      inside = inside && i >= 0 && i <= 0xFFFFFFFF;
      p[k] = static_cast<std::uint32_t>(i);
    }
    outside += inside ? 0 : 1;
  }
  std::vector<GridPoint> given = fit.points;
  std::sort(given.begin(), given.end());
  std::sort(points.begin(), points.end());
  if (outside > 0 || given != points) {
    std::vector<GridPoint> missing;
    std::set_difference(given.begin(), given.end(), points.begin(), points.end(),
                        std::back_inserter(missing));
    failPoints(args, points.size(), given.size(), std::max<std::uint64_t>(outside, missing.size()));
  }
  return fit;
}

/// An array of the original as it was, without the points that were dropped.
ArrayValues keptTuples(const ArrayValues& array, const GridFit& fit) {
  if (fit.sourceIndex.empty()) return array;
  ArrayValues kept;
  static_cast<ArrayDescription&>(kept) = static_cast<const ArrayDescription&>(array);
  const std::size_t bytes = array.components * arrayValueSize(array.type);
  for (const std::uint64_t i : fit.sourceIndex) {
    if (array.type == ScalarType::String) {
      const auto first = array.strings.begin() + static_cast<std::ptrdiff_t>(i * array.components);
      kept.strings.insert(kept.strings.end(), first, first + array.components);
    } else {
      const auto first = array.values.begin() + static_cast<std::ptrdiff_t>(i * bytes);
      kept.values.insert(kept.values.end(), first, first + static_cast<std::ptrdiff_t>(bytes));
    }
  }
  return kept;
}

/// What is compared of a file and its original: the arrays that both have.
class ArrayCheck {
 public:
  ArrayCheck(const VerifyArguments& args, const FileInfo& info, const formats::Model& original,
             const GridFit& fit, const Restored& restored)
      : args_(args), info_(info), original_(original), fit_(fit), restored_(restored) {
    for (const ArrayValues& array : restored.arrays) pair(array);
    if (info.grid.form != Grid::Form::FloatBits || restored.points.empty()) return;
    ArrayValues given = coordinatesArray(original.type);
    given.values = original.positions;
    if (original.type != info.grid.scalarType) {
      fail(std::string("its coordinates are ") + scalarName(original.type));
    }
    kept_.push_back(keptTuples(given, fit));
    held_.arrays.push_back(restored.coordinates.view());
    hasCoordinates_ = true;
  }

  /// Throws Error(Corrupt) if arrays differ by more than they may.
  std::string run() {
    if (info_.keepsOrder) requireOrder();
    const ArrayComparison result = compareArrays(given_, held_, partners());
    if (result.mismatch) {
      const std::uint64_t point = result.mismatch->point;
      const std::uint64_t index = fit_.sourceIndex.empty() ? point : fit_.sourceIndex[point];
      fail("the array " + oneLine(held_.arrays[result.mismatch->array].name, 40) +
           " differs at point " + withCommas(index) + " of the original, counted from 0");
    }
    return text(result);
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw Error(ErrorCode::Corrupt,
                args_.input + ": does not hold the arrays of " + args_.against + ": " + what);
  }

  void pair(const ArrayValues& array) {
    if (array.semantic == Semantic::Ids && array.name == "OriginalPointIds" &&
        array.type == ScalarType::UInt64 && array.components == 1) {
      ids_ = &array;
      return;
    }
    const auto& values = original_.values;
    const auto found = std::find_if(values.begin(), values.end(),
                                    [&](const ArrayValues& v) { return v.name == array.name; });
    if (found == values.end()) fail("it has no array " + oneLine(array.name, 40));
    if (found->type != array.type || found->components != array.components) {
      fail(oneLine(array.name, 40) + " is there " + std::to_string(found->components) + " x " +
           scalarName(found->type) + " instead of " + std::to_string(array.components) + " x " +
           scalarName(array.type));
    }
    kept_.push_back(keptTuples(*found, fit_));
    kept_.back().tolerance = array.tolerance;
    held_.arrays.push_back(array.view());
  }

  void requireOrder() const {
    for (std::size_t i = 0; i < fit_.points.size(); ++i) {
      if (fit_.points[i] == restored_.points[i]) continue;
      fail("point " + withCommas(i) + " is not in its place, though the file keeps the order");
    }
  }

  /// Who is who, where the file says so.
  std::optional<std::vector<std::uint64_t>> partners() {
    for (const ArrayValues& array : kept_) given_.arrays.push_back(array.view());
    given_.points = fit_.points;
    held_.points = restored_.points;
    const std::size_t count = restored_.points.size();
    std::vector<std::uint64_t> partners(count);
    if (info_.keepsOrder) {
      std::iota(partners.begin(), partners.end(), std::uint64_t{0});
      return partners;
    }
    if (ids_ == nullptr) return std::nullopt;
    std::memcpy(partners.data(), ids_->values.data(), count * sizeof(std::uint64_t));
    for (std::size_t j = 0; j < count; ++j) {
      const auto place =
          std::lower_bound(fit_.sourceIndex.begin(), fit_.sourceIndex.end(), partners[j]);
      if (!fit_.sourceIndex.empty()) {
        const bool isThere = place != fit_.sourceIndex.end() && *place == partners[j];
        partners[j] = isThere ? static_cast<std::uint64_t>(place - fit_.sourceIndex.begin())
                              : fit_.points.size();
      }
      if (partners[j] < fit_.points.size() && fit_.points[partners[j]] == restored_.points[j]) {
        continue;
      }
      fail("OriginalPointIds name another point than the one that they belong to");
    }
    return partners;
  }

  std::string text(const ArrayComparison& result) const {
    std::string text;
    const std::size_t arrays = held_.arrays.size() - (hasCoordinates_ ? 1 : 0);
    if (arrays > 0) {
      text += " with " + formats::counted(arrays, "array", "arrays");
      if (arrays < original_.values.size()) {
        text += " of " + withCommas(original_.values.size());
      }
    }
    if (info_.keepsOrder) text += " in their order";
    for (std::size_t a = 0; a < held_.arrays.size(); ++a) {
      if (result.greatestErrors[a] == 0) continue;
      text +=
          ", " + oneLine(held_.arrays[a].name, 40) + " within " + rounded(result.greatestErrors[a]);
    }
    return text;
  }

  const VerifyArguments& args_;
  const FileInfo& info_;
  const formats::Model& original_;
  const GridFit& fit_;
  const Restored& restored_;
  const ArrayValues* ids_ = nullptr;
  /// Whether the last array is that of the coordinates.
  bool hasCoordinates_ = false;
  std::vector<ArrayValues> kept_;
  PointTable given_;
  PointTable held_;
};

/// Compares the cells that the file has with those of the original.
std::string cellsCheck(const VerifyArguments& args, const FileInfo& info,
                       const formats::Model& original, const GridFit& fit,
                       const Restored& restored) {
  if (info.mesh.empty()) return "";
  std::vector<GridPoint> places = fit.points;
  if (!fit.sourceIndex.empty()) {
    places.assign(original.size(), GridPoint{});
    for (std::size_t j = 0; j < fit.sourceIndex.size(); ++j) {
      places[fit.sourceIndex[j]] = fit.points[j];
    }
  }
  if (!sameCells({original.mesh, places}, {restored.mesh, restored.points})) {
    throw Error(ErrorCode::Corrupt, args.input + ": does not hold the faces of " + args.against);
  }
  return " and " + cellsText(info.mesh.vertices, info.mesh.lines, info.mesh.faces);
}

std::string comparisonText(const VerifyArguments& args, const FileInfo& info,
                           const Restored& restored) {
  const formats::Model original = readOriginal(args);
  const GridFit fit = fitOriginal(args, info, original, restored.points);
  const std::string arrays = ArrayCheck(args, info, original, fit, restored).run();
  const std::string cells = cellsCheck(args, info, original, fit, restored);
  return ", those of " + args.against + arrays + cells + ", " + errorText(fit.exact, fit.maxError);
}

/// What coarse levels say of themselves; all that they are made of was decoded with the last one.
void verifyCoarseLevels(Decoder& decoder, unsigned threads) {
  DecodeOptions options;
  options.threads = threads;
  options.arrays = std::vector<std::string>();
  for (unsigned level = 0; level + 1 < decoder.info().layers.size(); ++level) {
    options.level = level;
    decoder.decodeTiles(options, [](const DecodedPoints&) {});
  }
}

void runVerify(const VerifyArguments& args) {
  InputFile input(args.input);
  Decoder decoder = naming(input.name(), [&] { return Decoder(input.source()); });
  std::uint64_t count = 0;
  Restored restored(decoder.info());
  {
    ProgressBar bar("verifying", args.quiet);
    DecodeOptions options;
    options.progress = bar.callback();
    options.threads = args.threads;
    naming(input.name(), [&] {
      verifyCoarseLevels(decoder, args.threads);
      if (!decoder.info().mesh.empty()) {
        DecodedPoints all = decoder.decode(options);
        count = all.points.size();
        restored.mesh = std::move(all.mesh);
        restored.append(std::move(all));
        return;
      }
      decoder.decodeTiles(options, [&](DecodedPoints&& tile) {
        count += tile.points.size();
        if (!args.against.empty()) restored.append(std::move(tile));
      });
    });
  }
  const FileInfo& info = decoder.info();
  std::string result = "every checksum holds, " + withCommas(count) + " points";
  if (!info.arrays.empty()) {
    result += " with " + formats::counted(info.arrays.size(), "array", "arrays");
  }
  if (!info.mesh.empty()) {
    result += " and " + cellsText(info.mesh.vertices, info.mesh.lines, info.mesh.faces);
  }
  if (args.lossy) {
    result += distanceText(args, info.grid, restored.points);
  } else if (!args.against.empty()) {
    result += comparisonText(args, info, restored);
  }
  if (!args.quiet) std::cout << input.name() << ": " << result << '\n';
}

}  // namespace

void addVerifyCommand(CLI::App& app) {
  auto args = std::make_shared<VerifyArguments>();
  CLI::App* command =
      app.add_subcommand("verify", "Decode a .bspc file and check every byte and point of it");
  command->add_option("file", args->input, "The .bspc file; - reads a pipe")->required();
  CLI::Option* against = command->add_option("--against", args->against,
                                             "The model it was made from, to compare with");
  command->add_option("--from", args->from, "Format of that model where its name does not tell")
      ->type_name("ply|obj|off|xyz|csv|las|pcd");
  command
      ->add_flag("--lossy", args->lossy,
                 "The file was coded with --stop-points or --stop-level:\n"
                 "count the points and say how far they are, instead of\n"
                 "asking for the same ones")
      ->needs(against);
  command->add_flag("--drop-nonfinite", args->dropNonFinite,
                    "Leave out the model's points with NaN or infinite coordinates");
  command->add_option("--threads", args->threads, "Threads (default: as many as the machine has)")
      ->option_text("N");
  command->add_flag("-q,--quiet", args->quiet, "Print nothing but errors");
  command->callback([args] { runVerify(*args); });
  command->footer(
      "Examples:\n"
      "  bspc verify scan.bspc\n"
      "  bspc verify scan.bspc --against scan.ply   compares points and arrays too");
}

}  // namespace bspc::cli
