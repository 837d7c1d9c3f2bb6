#include <iostream>
#include <memory>
#include <vector>

#include "bspc/error.h"
#include "bspc/join.h"
#include "cli/commands.h"
#include "cli/input_file.h"
#include "cli/naming.h"
#include "cli/output_file.h"
#include "cli/progress_bar.h"
#include "cli/text.h"

namespace bspc::cli {

namespace {

struct JoinArguments {
  std::vector<std::string> inputs;
  std::string output;
  std::string layout = "progressive";
  bool force = false;
  bool quiet = false;
};

void runJoin(const JoinArguments& args) {
  std::vector<std::unique_ptr<InputFile>> files;
  std::vector<std::shared_ptr<ByteSource>> sources;
  for (const std::string& path : args.inputs) {
    files.push_back(std::make_unique<InputFile>(path));
    // Opened once on its own, so that what is wrong with a file is said with its name.
    sources.push_back(files.back()->source());
    naming(files.back()->name(), [&] { return Decoder(sources.back()).info().points; });
  }
  OutputFile output(args.output, args.force);
  OutputSink sink(output);
  JoinReport report;
  {
    ProgressBar bar("joining", args.quiet);
    JoinOptions options;
    options.layout = args.layout == "streaming" ? Layout::Streaming : Layout::Progressive;
    options.progress = bar.callback();
    report = naming(output.name(), [&] { return join(sources, sink, options); });
    output.commit();
  }
  if (args.quiet) return;
  std::cerr << output.name() << ": " << withCommas(report.points) << " points in "
            << withCommas(report.fileBytes) << " bytes, " << withCommas(report.tiles)
            << " tiles of " << withCommas(args.inputs.size()) << " files\n";
}

}  // namespace

void addJoinCommand(CLI::App& app) {
  auto args = std::make_shared<JoinArguments>();
  CLI::App* command =
      app.add_subcommand("join", "Put .bspc files on one grid together, without decoding them");
  command->add_option("inputs", args->inputs, "The .bspc files")
      ->required()
      ->option_text("FILE...");
  command->add_option("-o,--output", args->output, "The joined .bspc file; - writes to a pipe")
      ->required()
      ->option_text("FILE");
  command->add_option("--layout", args->layout, "Index in front (the default) or at the end")
      ->option_text("progressive|streaming")
      ->check(CLI::IsMember({"progressive", "streaming"}));
  command->add_flag("-f,--force", args->force, "Replace an existing output file");
  command->add_flag("-q,--quiet", args->quiet, "Print nothing but errors");
  command->callback([args] { runJoin(*args); });
  command->footer(
      "Examples:\n"
      "  bspc encode west.ply west.bspc\n"
      "  bspc encode east.ply east.bspc --grid west.bspc\n"
      "  bspc join west.bspc east.bspc -o all.bspc");
}

}  // namespace bspc::cli
