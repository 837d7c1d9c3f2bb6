#include <algorithm>
#include <array>
#include <cmath>
#include <iostream>
#include <memory>

#include "bspc/decoder.h"
#include "bspc/error.h"
#include "cli/commands.h"
#include "cli/input_file.h"
#include "cli/model_files.h"
#include "cli/naming.h"
#include "cli/nearest_distance.h"
#include "cli/progress_bar.h"
#include "cli/text.h"

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
  return readModelFile(args.against, args.from, true, bar.callback());
}

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

/// Puts the original on the file's grid and compares the multisets of grid points.
GridFit compare(const VerifyArguments& args, const FileInfo& info, std::vector<GridPoint> points) {
  const formats::Model original = readOriginal(args);
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
  std::sort(fit.points.begin(), fit.points.end());
  std::sort(points.begin(), points.end());
  if (outside > 0 || fit.points != points) {
    std::vector<GridPoint> missing;
    std::set_difference(fit.points.begin(), fit.points.end(), points.begin(), points.end(),
                        std::back_inserter(missing));
    throw Error(ErrorCode::Corrupt,
                args.input + ": does not hold the points of " + args.against + ": " +
                    withCommas(points.size()) + " points against " + withCommas(fit.points.size()) +
                    ", " + withCommas(std::max<std::uint64_t>(outside, missing.size())) +
                    " of the original's are not there; --lossy tells how far the points of a file "
                    "that was coded with lossy stops are");
  }
  return fit;
}

void runVerify(const VerifyArguments& args) {
  InputFile input(args.input);
  Decoder decoder = naming(input.name(), [&] { return Decoder(input.source()); });
  std::uint64_t count = 0;
  std::vector<GridPoint> points;
  {
    ProgressBar bar("verifying", args.quiet);
    DecodeOptions options;
    options.progress = bar.callback();
    options.threads = args.threads;
    naming(input.name(), [&] {
      decoder.decodeTiles(options, [&](DecodedPoints&& tile) {
        count += tile.points.size();
        if (args.against.empty()) return;
        points.insert(points.end(), tile.points.begin(), tile.points.end());
      });
    });
  }
  std::string result = "every checksum holds, " + withCommas(count) + " points";
  if (args.lossy) {
    result += distanceText(args, decoder.info().grid, points);
  } else if (!args.against.empty()) {
    const GridFit fit = compare(args, decoder.info(), std::move(points));
    result += ", those of " + args.against + ", " + errorText(fit.exact, fit.maxError);
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
      "  bspc verify scan.bspc --against scan.ply   also says how exact the points are");
}

}  // namespace bspc::cli
