#include <iostream>
#include <memory>
#include <optional>

#include "bspc/decoder.h"
#include "bspc/error.h"
#include "cli/commands.h"
#include "cli/input_file.h"
#include "cli/model_files.h"
#include "cli/naming.h"
#include "cli/output_file.h"
#include "cli/progress_bar.h"
#include "cli/restored_points.h"
#include "cli/text.h"

namespace bspc::cli {

namespace {

struct DecodeArguments {
  std::string input;
  std::string output;
  std::string to;
  std::optional<unsigned> level;
  std::optional<std::uint64_t> maxPoints;
  std::optional<unsigned> colourLevel;
  std::optional<double> maxMemory;
  bool counts = false;
  bool partial = false;
  bool force = false;
  bool quiet = false;
};

OpenOptions openOptions(const DecodeArguments& args) {
  OpenOptions options;
  options.allowPartial = args.partial;
  if (args.maxMemory) {
    options.limits.memoryBytes = static_cast<std::uint64_t>(*args.maxMemory * (1 << 30));
  }
  return options;
}

void printReport(const std::string& name, const FileInfo& info, const DecodedPoints& points) {
  std::cerr << name << ": " << withCommas(points.points.size()) << " points";
  if (!points.complete) {
    std::cerr << " that stand for " << withCommas(info.points) << " (level " << points.level
              << " of 0 to " << info.layers.size() - 1 << ')';
    if (info.wholeLayers < info.layers.size()) std::cerr << "; the file ends early";
  }
  std::cerr << '\n';
}

void runDecode(const DecodeArguments& args) {
  const formats::Format format = args.output == "-" && args.to.empty()
                                     ? formats::Format::Ply
                                     : chooseFormat(args.to, args.output, "--to");
  InputFile input(args.input);
  OutputFile output(args.output, args.force);
  Decoder decoder =
      naming(input.name(), [&] { return Decoder(input.source(), openOptions(args)); });
  DecodedPoints points;
  {
    ProgressBar bar("decoding", args.quiet);
    DecodeOptions options;
    options.level = args.level;
    options.maxPoints = args.maxPoints;
    options.cellLevel = args.colourLevel;
    options.wantCounts = args.counts;
    options.progress = bar.callback();
    points = naming(input.name(), [&] { return decoder.decode(options); });
    bar.clear();
    ProgressBar writing("writing", args.quiet);
    const RestoredPoints restored(decoder.info().grid, points);
    try {
      formats::writeModel(output.stream(), format, restored.model(), writing.callback());
    } catch (const formats::FormatError& error) {
      throw Error(ErrorCode::Io, output.name() + ": " + error.what());
    }
    output.commit();
  }
  if (!args.quiet) printReport(output.name(), decoder.info(), points);
}

}  // namespace

void addDecodeCommand(CLI::App& app) {
  auto args = std::make_shared<DecodeArguments>();
  CLI::App* command = app.add_subcommand("decode", "Restore points from a .bspc file");
  command->add_option("input", args->input, "The .bspc file; - reads a pipe")->required();
  command
      ->add_option("output", args->output,
                   "Model: PLY (binary), OBJ, OFF, XYZ or CSV; - writes PLY to a pipe")
      ->required();
  command->add_option("--level", args->level, "Decode layers 0 to LEVEL only")
      ->group("Level of detail");
  command
      ->add_option("--max-points", args->maxPoints,
                   "At most so many points: the finest level that fits")
      ->group("Level of detail");
  command
      ->add_flag("--counts", args->counts,
                 "Add PointCount: how many points each stands for (PLY, XYZ, CSV)")
      ->group("Level of detail");
  command
      ->add_option("--color-level", args->colourLevel,
                   "Add CellId: the cell of that level that each point lies in")
      ->group("Level of detail");
  command->add_flag("--partial", args->partial,
                    "Decode what is whole of a file that was cut short");
  command->add_option("--max-memory", args->maxMemory, "Memory limit in GiB (default 16)")
      ->check(CLI::PositiveNumber);
  command->add_option("--to", args->to, "Format of the output where its name does not tell")
      ->type_name("ply|obj|off|xyz|csv");
  command->add_flag("-f,--force", args->force, "Replace an existing output file");
  command->add_flag("-q,--quiet", args->quiet, "Print nothing but errors");
  command->callback([args] { runDecode(*args); });
  command->footer(
      "Examples:\n"
      "  bspc decode scan.bspc scan.ply\n"
      "  bspc decode scan.bspc preview.ply --max-points 20000 --counts\n"
      "  bspc decode scan.bspc cells.ply --color-level 1\n"
      "  bspc decode scan.bspc - --to xyz | head");
}

}  // namespace bspc::cli
