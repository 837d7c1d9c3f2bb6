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
#include "cli/progress_bar.h"
#include "cli/text.h"

namespace bspc::cli {

namespace {

struct VerifyArguments {
  std::string input;
  std::string against;
  std::string from;
  bool dropNonFinite = false;
  unsigned threads = 0;
  bool quiet = false;
};

/// Puts the original on the file's grid and compares the multisets of grid points.
GridFit compare(const VerifyArguments& args, const FileInfo& info, std::vector<GridPoint> points) {
  formats::Model original;
  {
    ProgressBar bar("reading", args.quiet);
    original = readModelFile(args.against, args.from, true, bar.callback());
  }
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
                    " of the original's are not there");
  }
  return fit;
}

void runVerify(const VerifyArguments& args) {
  InputFile input(args.input);
  Decoder decoder = naming(input.name(), [&] { return Decoder(input.source()); });
  DecodedPoints decoded;
  {
    ProgressBar bar("verifying", args.quiet);
    DecodeOptions options;
    options.progress = bar.callback();
    options.threads = args.threads;
    decoded = naming(input.name(), [&] { return decoder.decode(options); });
  }
  std::string result = "every checksum holds, " + withCommas(decoded.points.size()) + " points";
  if (!args.against.empty()) {
    const GridFit fit = compare(args, decoder.info(), std::move(decoded.points));
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
  command->add_option("--against", args->against, "The model it was made from, to compare with");
  command->add_option("--from", args->from, "Format of that model where its name does not tell")
      ->type_name("ply|obj|off|xyz|csv|las|pcd");
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
