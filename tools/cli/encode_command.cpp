#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>

#include "bspc/encoder.h"
#include "bspc/error.h"
#include "bspc/stream_encoder.h"
#include "cli/commands.h"
#include "cli/interrupts.h"
#include "cli/model_files.h"
#include "cli/naming.h"
#include "cli/output_file.h"
#include "cli/progress_bar.h"
#include "cli/scratch_file.h"
#include "cli/shared_options.h"
#include "cli/text.h"
#include "cli/usage_error.h"
#include "formats/wording.h"

namespace bspc::cli {

namespace {

struct EncodeArguments : SourceArguments {
  std::string output;
  std::string method;
  std::string layout;
  std::string effort = "auto";
  double seconds = 0;
  unsigned layers = 0;
  std::uint64_t tilePoints = 0;
  unsigned threads = 0;
  double memory = 1;
  std::uint64_t stopPoints = 0;
  std::optional<unsigned> stopLevel;
  bool force = false;
  bool quiet = false;
};

/// Empty for the encoder's choice.
std::optional<unsigned> effortOf(const EncodeArguments& args) {
  if (args.effort == "auto") return std::nullopt;
  const auto effort = static_cast<unsigned>(args.effort[0] - '0');
  if (args.seconds != 0) throw UsageError("--seconds chooses an effort; leave --effort out");
  if (args.method.empty()) return effort;
  const bool fast = args.method == methodName(Method::Fast);
  if (!fast && args.method != methodName(Method::Predictive)) {
    throw UsageError("method " + args.method + " has no --effort; leave one of the two out");
  }
  if (fast != (effort <= 4)) {
    throw UsageError("--effort " + args.effort + " is not one of method " + args.method +
                     ": 1 to 4 are method fast, 5 to 9 method predictive");
  }
  return effort;
}

EncodeOptions encodeOptions(const EncodeArguments& args) {
  EncodeOptions options;
  options.grid = gridRequest(args);
  options.effort = effortOf(args);
  options.seconds = args.seconds;
  options.layers = args.layers;
  options.tilePoints = args.tilePoints;
  options.threads = args.threads;
  options.stopPoints = args.stopPoints;
  options.stopLevel = args.stopLevel;
  options.originalIds = args.originalIds;
  if (!args.method.empty()) options.method = methodFromName(args.method);
  // To a pipe the index goes last, so that a reader of the pipe sees tiles as they come.
  const std::string layout =
      !args.layout.empty() ? args.layout : (args.output == "-" ? "streaming" : "progressive");
  options.layout = layout == "streaming" ? Layout::Streaming : Layout::Progressive;
  return options;
}

std::string bitsText(std::uint64_t bytes, std::uint64_t points) {
  return fixed(8.0 * static_cast<double>(bytes) / static_cast<double>(points), 3);
}

/// " (12.1 positions, 5.2 in 3 arrays, 2.9 order)", if there is more than positions.
std::string sharesText(const EncodeReport& report) {
  if (report.arrays.empty() && report.orderBytes == 0 && report.meshBytes == 0) return "";
  std::string text = " (" + bitsText(report.geometryBytes, report.points) + " positions";
  std::uint64_t arrayBytes = 0;
  for (const ArrayReport& array : report.arrays) arrayBytes += array.bytes;
  if (!report.arrays.empty()) {
    text += ", " + bitsText(arrayBytes, report.points) + " in " +
            formats::counted(report.arrays.size(), "array", "arrays");
  }
  if (report.meshBytes > 0) text += ", " + bitsText(report.meshBytes, report.points) + " faces";
  if (report.orderBytes > 0) text += ", " + bitsText(report.orderBytes, report.points) + " order";
  return text + ")";
}

std::string arrayErrorsText(const EncodeReport& report) {
  std::string text;
  for (const ArrayReport& array : report.arrays) {
    if (array.greatestError == 0) continue;
    text += "; " + oneLine(array.name, 40) + " within " + rounded(array.greatestError);
  }
  return text;
}

void printReport(const EncodeArguments& args, const std::string& name, const EncodeReport& report) {
  std::cerr << name << ": " << withCommas(report.points) << " points in "
            << withCommas(report.fileBytes) << " bytes";
  if (report.points > 0) {
    std::cerr << ", " << bitsText(report.fileBytes, report.points) << " bits per point"
              << sharesText(report);
  }
  std::error_code error;
  const std::uintmax_t inputBytes =
      args.input == "-" ? 0 : std::filesystem::file_size(args.input, error);
  if (inputBytes > 0 && !error) {
    std::cerr << ", 1/"
              << fixed(static_cast<double>(inputBytes) / static_cast<double>(report.fileBytes), 2)
              << " of " << args.input;
  }
  std::cerr << "; " << errorText(report.exact, report.maxError) << arrayErrorsText(report) << "; "
            << methodName(report.method) << ", " << gridText(report.grid);
  const bool wanted = args.layout == "streaming" || args.output == "-";
  if (report.layout == Layout::Streaming && !wanted) {
    std::cerr << "; streaming layout, for it takes more than --memory " << args.memory;
  }
  if (report.dropped > 0) {
    std::cerr << "; " << withCommas(report.dropped) << " non-finite points left out";
  }
  std::cerr << '\n';
}

/// Streams have no cells: a mesh is read whole.
EncodeReport encodeWhole(ModelPoints& points, ByteSink& sink, const EncodeOptions& options) {
  const WholePoints whole(points);
  return encode(whole.view(), sink, options);
}

void runEncode(const EncodeArguments& args) {
  StreamOptions options;
  options.encoding = encodeOptions(args);
  options.memoryBytes = static_cast<std::uint64_t>(args.memory * (1 << 30));
  options.scratch = [] { return std::make_unique<ScratchFile>(); };
  OutputFile output(args.output, args.force);
  OutputSink sink(output);
  EncodeReport report;
  {
    ProgressBar reading("reading", args.quiet);
    ProgressBar encoding("encoding", args.quiet);
    ModelPoints points(args.input, args.from, args.content, reading.callback());
    options.encoding.grid.knownLattice = points.info().lattice;
    options.encoding.metadata = points.metadata();
    options.encoding.keepOrder = keepsOrder(args, points.info());
    options.encoding.progress = [&, draw = encoding.callback()](double share) {
      if (!points.ended()) return !interrupted();
      reading.clear();
      return draw(share);
    };
    report = naming(args.input, [&] {
      return points.mayHaveMesh() ? encodeWhole(points, sink, options.encoding)
                                  : encodeStream(points, sink, options);
    });
    output.commit();
  }
  if (!args.quiet) printReport(args, output.name(), report);
}

std::string knownMethods() {
  std::string names;
  for (const Method method : availableMethods()) {
    names += (names.empty() ? "" : ", ") + std::string(methodName(method));
  }
  return names;
}

}  // namespace

void addEncodeCommand(CLI::App& app) {
  auto args = std::make_shared<EncodeArguments>();
  CLI::App* command = app.add_subcommand("encode", "Compress a model's points to a .bspc file");
  command
      ->add_option("input", args->input,
                   "Model: PLY, OBJ, OFF, XYZ, CSV, LAS or PCD; - reads a pipe")
      ->required();
  command->add_option("output", args->output, "The .bspc file; - writes to a pipe")->required();
  const auto methods = [](const std::string& name) {
    return methodFromName(name) ? std::string()
                                : "there is no such method; known: " + knownMethods();
  };
  command->add_option("--method", args->method, "How to code positions: " + knownMethods())
      ->type_name("NAME")
      ->check(methods)
      ->group("Coding");
  command
      ->add_option("--effort", args->effort,
                   "1 (quickest) to 9 (smallest), or auto, the default: 9 up to 20,000 points, 2 "
                   "above; 1 to 4 are method fast, 5 to 9 method predictive")
      ->option_text("N")
      ->check([](const std::string& text) {
        const bool digit = text.size() == 1 && text[0] >= '1' && text[0] <= '9';
        return digit || text == "auto" ? std::string() : "must be 1 to 9 or auto";
      })
      ->group("Coding");
  command
      ->add_option("--seconds", args->seconds,
                   "The greatest effort that takes about so long at most on one core")
      ->option_text("S")
      ->check(positiveNumber)
      ->group("Coding");
  command->add_option("--layers", args->layers, "Layers of detail, 1 to 32 (default: by size)")
      ->option_text("N")
      ->check(CLI::Range(1U, kMaxLayers))
      ->group("Coding");
  command
      ->add_option("--tile-points", args->tilePoints, "Most points of a tile (default: by method)")
      ->option_text("N")
      ->check(CLI::Range(std::uint64_t{1}, std::uint64_t{0xFFFFFFFF}))
      ->group("Coding");
  command
      ->add_option("--memory", args->memory,
                   "Memory to use, in GiB (default 1); a larger set goes through a temporary\n"
                   "file and gets the streaming layout")
      ->option_text("GIB")
      ->check(positiveNumber)
      ->group("Coding");
  command->add_option("--threads", args->threads, "Threads (default: as many as the machine has)")
      ->option_text("N")
      ->group("Coding");
  command->add_option("--layout", args->layout, "Index in front (the default) or at the end")
      ->option_text("progressive|streaming")
      ->check(CLI::IsMember({"progressive", "streaming"}))
      ->group("Coding");
  command
      ->add_option("--stop-points", args->stopPoints,
                   "Lossy: cells of at most N points stay undivided, each\n"
                   "point coming back as the middle of its cell (bsp, kd)")
      ->option_text("N")
      ->group("Coding");
  command
      ->add_option("--stop-level", args->stopLevel,
                   "Lossy: so do cells that L cuts have made (bsp, kd)")
      ->option_text("L")
      ->group("Coding");
  addGridOptions(*command, *args);
  addContentOptions(*command, *args);
  addFromOption(*command, *args);
  command->add_flag("-f,--force", args->force, "Replace an existing output file");
  command->add_flag("-q,--quiet", args->quiet, "Print nothing but errors");
  command->callback([args] { runEncode(*args); });
  command->footer(
      "Examples:\n"
      "  bspc encode scan.ply scan.bspc                    as exact as the data are\n"
      "  bspc encode scan.ply scan.bspc --precision 0.001  to the millimetre, if in metres\n"
      "  bspc encode bunny.off bunny.bspc --bits 12 --no-faces\n"
      "  bspc encode tile.las tile.bspc                    exact, with all attributes\n"
      "  bspc encode tile.las tile.bspc --arrays Classification,RGB --crs EPSG:25832\n"
      "  bspc encode head.ply head.bspc --keep-order --array-precision Normals=0.5\n"
      "  cat scan.ply | bspc encode - - --from ply > scan.bspc");
}

}  // namespace bspc::cli
