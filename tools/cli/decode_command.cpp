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
#include "cli/query_options.h"
#include "cli/restored_points.h"
#include "cli/text.h"
#include "formats/model_writer.h"

namespace bspc::cli {

namespace {

struct DecodeArguments {
  std::string input;
  std::string output;
  std::string to;
  QueryArguments query;
  std::optional<unsigned> colourLevel;
  std::optional<double> maxMemory;
  unsigned threads = 0;
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

/// What is known of the decoded points once they are written.
struct Summary {
  std::uint64_t points = 0;
  unsigned level = 0;
  bool complete = true;
};

void printReport(const DecodeArguments& args, const std::string& name, const FileInfo& info,
                 const Summary& summary) {
  std::cerr << name << ": " << withCommas(summary.points) << " points";
  if (!args.query.box.empty()) {
    std::cerr << " in the box, of " << withCommas(info.points);
    if (summary.level + 1 < info.layers.size()) std::cerr << " (level " << summary.level << ')';
  } else if (!summary.complete) {
    std::cerr << " that stand for " << withCommas(info.points) << " (level " << summary.level
              << " of 0 to " << info.layers.size() - 1 << ')';
    if (info.wholeLayers < info.layers.size()) std::cerr << "; the file ends early";
  }
  std::cerr << '\n';
}

formats::ModelLayout layoutOf(const DecodeArguments& args, const FileInfo& info,
                              std::uint64_t points) {
  formats::ModelLayout layout{info.grid.scalarType, points, {}};
  if (args.counts) layout.columns.push_back({"PointCount", info.points});
  if (args.colourLevel) layout.columns.push_back({"CellId", info.points});
  return layout;
}

/// Where decoded points go.
class Restorer {
 public:
  Restorer(const DecodeArguments& args, formats::Format format, OutputFile& output)
      : args_(args), format_(format), output_(output) {}

  /// Decodes and writes tile by tile where the number of points is known before.
  Summary run(Decoder& decoder, DecodeOptions options) {
    const QueryCost cost = decoder.cost(options);
    const bool counted = !options.box && !(options.maxPoints && cost.points > *options.maxPoints);
    if (!counted) return runAtOnce(decoder, options);
    Summary summary;
    formats::ModelWriter writer = startWriter(decoder.info(), cost.points);
    decoder.decodeTiles(options, [&](DecodedPoints&& points) {
      const RestoredPoints restored(decoder.info().grid, points);
      writing([&] { writer.append(restored.model()); });
      summary.points += points.points.size();
      summary.level = points.level;
      summary.complete = points.complete;
    });
    writing([&] { writer.finish(); });
    return summary;
  }

 private:
  Summary runAtOnce(Decoder& decoder, const DecodeOptions& options) {
    const DecodedPoints points = decoder.decode(options);
    const RestoredPoints restored(decoder.info().grid, points);
    formats::ModelWriter writer = startWriter(decoder.info(), points.points.size());
    writing([&] {
      writer.append(restored.model());
      writer.finish();
    });
    return {points.points.size(), points.level, points.complete};
  }

  formats::ModelWriter startWriter(const FileInfo& info, std::uint64_t points) {
    try {
      return {output_.stream(), format_, layoutOf(args_, info, points)};
    } catch (const formats::FormatError& error) {
      throw NamedError(ErrorCode::Io, output_.name() + ": " + error.what());
    }
  }

  template <class Work>
  void writing(Work work) {
    try {
      work();
    } catch (const formats::FormatError& error) {
      throw NamedError(ErrorCode::Io, output_.name() + ": " + error.what());
    }
  }

  const DecodeArguments& args_;
  formats::Format format_;
  OutputFile& output_;
};

void runDecode(const DecodeArguments& args) {
  const formats::Format format = args.output == "-" && args.to.empty()
                                     ? formats::Format::Ply
                                     : chooseOutputFormat(args.to, args.output);
  DecodeOptions options = decodeOptions(args.query);
  options.cellLevel = args.colourLevel;
  options.wantCounts = args.counts;
  options.threads = args.threads;
  InputFile input(args.input);
  OutputFile output(args.output, args.force);
  Decoder decoder =
      naming(input.name(), [&] { return Decoder(input.source(), openOptions(args)); });
  Summary summary;
  {
    ProgressBar bar("decoding", args.quiet);
    options.progress = bar.callback();
    Restorer restorer(args, format, output);
    summary = naming(input.name(), [&] { return restorer.run(decoder, options); });
    output.commit();
  }
  if (!args.quiet) printReport(args, output.name(), decoder.info(), summary);
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
  addQueryOptions(*command, args->query);
  command
      ->add_flag("--counts", args->counts,
                 "Add PointCount: how many points each stands for (PLY, XYZ, CSV)")
      ->group("Columns beside x, y, z");
  command
      ->add_option("--color-level", args->colourLevel,
                   "Add CellId: the cell of that level that each point lies in")
      ->group("Columns beside x, y, z");
  command->add_flag("--partial", args->partial,
                    "Decode what is whole of a file that was cut short");
  command->add_option("--threads", args->threads, "Threads (default: as many as the machine has)")
      ->option_text("N");
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
      "  bspc decode scan.bspc part.ply --box 0,0,0,10,10,2.5\n"
      "  bspc decode scan.bspc - --to xyz | head");
}

}  // namespace bspc::cli
