#include <array>
#include <iostream>
#include <memory>
#include <optional>
#include <vector>

#include "bspc/decoder.h"
#include "bspc/error.h"
#include "cli/array_choice.h"
#include "cli/commands.h"
#include "cli/input_file.h"
#include "cli/model_files.h"
#include "cli/naming.h"
#include "cli/output_file.h"
#include "cli/progress_bar.h"
#include "cli/restored_points.h"
#include "cli/shared_options.h"
#include "cli/text.h"
#include "formats/model_writer.h"
#include "formats/wording.h"

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
  std::optional<std::string> arrays;
  bool positionsOnly = false;
  bool noFaces = false;
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
  std::size_t arrays = 0;
  double formatError = 0;
  std::uint64_t cells = 0;
};

/// The arrays that are wished for: their places in the file's table.
std::vector<std::size_t> wishedArrays(const DecodeArguments& args, const FileInfo& info) {
  if (args.positionsOnly) return {};
  std::vector<ArrayDescription> descriptions(info.arrays.begin(), info.arrays.end());
  return chooseArrays({args.arrays, {}, {}}, descriptions);
}

void printReport(const DecodeArguments& args, const std::string& name, const FileInfo& info,
                 const Summary& summary) {
  std::cerr << name << ": " << withCommas(summary.points) << " points";
  if (summary.arrays > 0) {
    std::cerr << " with " << formats::counted(summary.arrays, "array", "arrays");
  }
  if (!args.query.box.empty()) {
    std::cerr << " in the box, of " << withCommas(info.points);
    if (summary.level + 1 < info.layers.size()) std::cerr << " (level " << summary.level << ')';
  } else if (!summary.complete) {
    std::cerr << " that stand for " << withCommas(info.points) << " (level " << summary.level
              << " of 0 to " << info.layers.size() - 1 << ')';
    if (info.wholeLayers < info.layers.size()) std::cerr << "; the file ends early";
  }
  const std::size_t wished = wishedArrays(args, info).size();
  if (summary.arrays < wished) {
    std::cerr << "; " << formats::counted(wished - summary.arrays, "array has", "arrays have")
              << " no values at this level";
  }
  if (summary.cells > 0) {
    std::cerr << "; " << formats::counted(summary.cells, "face", "faces");
  } else if (!info.mesh.empty()) {
    std::cerr << "; without the faces";
  }
  if (!info.mesh.arrays.empty()) {
    std::cerr << "; without " << formats::counted(info.mesh.arrays.size(), "array", "arrays")
              << " of the faces";
  }
  if (summary.formatError > 0) {
    std::cerr << "; LAS has rounded coordinates by at most " << rounded(summary.formatError);
  }
  std::cerr << '\n';
}

/// A box with all points of the file in it.
std::array<std::array<double, 3>, 2> boundsOf(const FileInfo& info) {
  std::array<std::array<double, 3>, 2> bounds{};
  for (std::size_t k = 0; k < 3; ++k) {
    const int axis = static_cast<int>(k);
    bounds[0][k] = restoredCoordinate(info.grid, axis, info.lower[k]);
    bounds[1][k] = restoredCoordinate(info.grid, axis, info.upper[k]);
  }
  return bounds;
}

/// Where decoded points go.
class Restorer {
 public:
  Restorer(const DecodeArguments& args, formats::Format format, OutputFile& output)
      : args_(args), format_(format), output_(output) {}

  /// Decodes and writes tile by tile where the number of points is known before.
  Summary run(Decoder& decoder, DecodeOptions options) {
    const FileInfo& info = decoder.info();
    for (const std::size_t a : wishedArrays(args_, info)) arrays_.push_back(info.arrays[a]);
    options.arrays.emplace();
    for (const ArrayInfo& array : arrays_) options.arrays->push_back(array.name);
    const QueryCost cost = decoder.cost(options);
    const bool counted = !options.box && !(options.maxPoints && cost.points > *options.maxPoints);
    options.mesh = wantsMesh(info);
    if (!counted || options.mesh) return runAtOnce(decoder, options);
    Summary summary;
    summary.arrays = arraysAt(cost.level).size();
    formats::ModelWriter writer = startWriter(info, cost.points, cost.level);
    decoder.decodeTiles(options, [&](DecodedPoints&& points) {
      const RestoredPoints restored(info, points);
      writing([&] { writer.append(restored.view()); });
      summary.points += points.points.size();
      summary.level = points.level;
      summary.complete = points.complete;
    });
    writing([&] { writer.finish(); });
    summary.formatError = writer.greatestError();
    return summary;
  }

 private:
  Summary runAtOnce(Decoder& decoder, const DecodeOptions& options) {
    const DecodedPoints points = decoder.decode(options);
    const RestoredPoints restored(decoder.info(), points);
    mesh_ = points.mesh.empty() ? nullptr : &points.mesh;
    formats::ModelWriter writer = startWriter(decoder.info(), points.points.size(), points.level);
    writing([&] {
      writer.append(restored.view());
      writer.finish();
    });
    return {points.points.size(), points.level,           points.complete,
            points.arrays.size(), writer.greatestError(), points.mesh.size()};
  }

  /// Whether the cells are wished for and the format has a place for them.
  bool wantsMesh(const FileInfo& info) const {
    const bool holdsMesh = format_ == formats::Format::Ply || format_ == formats::Format::Obj ||
                           format_ == formats::Format::Off;
    return holdsMesh && !info.mesh.empty() && !args_.noFaces && !args_.positionsOnly;
  }

  /// The wished arrays that have values at the level.
  std::vector<ArrayDescription> arraysAt(unsigned level) const {
    std::vector<ArrayDescription> arrays;
    for (const ArrayInfo& array : arrays_) {
      if (array.firstLevel <= level) arrays.push_back(array);
    }
    return arrays;
  }

  formats::ModelLayout layoutOf(const FileInfo& info, std::uint64_t points, unsigned level) const {
    formats::ModelLayout layout;
    layout.type = info.grid.scalarType;
    layout.points = points;
    layout.arrays = arraysAt(level);
    if (args_.counts) layout.arrays.push_back(countsDescription(info.points));
    if (args_.colourLevel) layout.arrays.push_back(cellIdsDescription(info.points));
    layout.mesh = mesh_;
    layout.metadata = info.metadata;
    layout.keepsOrder = info.keepsOrder && points == info.points;
    if (info.grid.form != Grid::Form::FloatBits) layout.lattice = info.grid;
    if (info.points > 0) layout.bounds = boundsOf(info);
    layout.mayPatch = output_.isFile();
    return layout;
  }

  formats::ModelWriter startWriter(const FileInfo& info, std::uint64_t points, unsigned level) {
    try {
      return {output_.stream(), format_, layoutOf(info, points, level)};
    } catch (const formats::FormatError& error) {
      throw NamedError(ErrorCode::Io, output_.name() + ": " + error.what() +
                                          " (--arrays and --positions-only leave arrays out)");
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
  /// Those of the file that are wished for.
  std::vector<ArrayInfo> arrays_;
  const MeshCells* mesh_ = nullptr;  ///< what is written behind the points
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
                   "Model: PLY, OBJ, OFF, XYZ, CSV, LAS or PCD; - writes PLY to a pipe")
      ->required();
  addQueryOptions(*command, args->query);
  command->add_option("--arrays", args->arrays, "These arrays only; `info` lists their names")
      ->option_text("NAME,...")
      ->group("Arrays");
  command->add_flag("--positions-only", args->positionsOnly, "No arrays, no faces")
      ->group("Arrays");
  command->add_flag("--no-faces", args->noFaces, "No faces")->group("Arrays");
  command->add_flag("--counts", args->counts, "Add PointCount: how many points each stands for")
      ->group("Arrays");
  command
      ->add_option("--color-level", args->colourLevel,
                   "Add CellId: the cell of that level that each point lies in")
      ->option_text("LEVEL")
      ->group("Arrays");
  command->add_flag("--partial", args->partial,
                    "Decode what is whole of a file that was cut short");
  command->add_option("--threads", args->threads, "Threads (default: as many as the machine has)")
      ->option_text("N");
  command->add_option("--max-memory", args->maxMemory, "Memory limit in GiB (default 16)")
      ->option_text("GIB")
      ->check(CLI::PositiveNumber);
  command->add_option("--to", args->to, "Format of the output where its name does not tell")
      ->type_name("ply|obj|off|xyz|csv|las|pcd");
  command->add_flag("-f,--force", args->force, "Replace an existing output file");
  command->add_flag("-q,--quiet", args->quiet, "Print nothing but errors");
  command->callback([args] { runDecode(*args); });
  command->footer(
      "Examples:\n"
      "  bspc decode scan.bspc scan.ply\n"
      "  bspc decode tile.bspc tile.las\n"
      "  bspc decode tile.bspc classes.csv --arrays Classification,RGB\n"
      "  bspc decode scan.bspc preview.ply --max-points 20000 --counts\n"
      "  bspc decode scan.bspc cells.ply --color-level 1\n"
      "  bspc decode scan.bspc part.ply --box 0,0,0,10,10,2.5\n"
      "  bspc decode scan.bspc - --to xyz | head");
}

}  // namespace bspc::cli
