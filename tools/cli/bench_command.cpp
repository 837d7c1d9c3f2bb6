#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <iostream>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "bspc/encoder.h"
#include "bspc/error.h"
#include "cli/commands.h"
#include "cli/effort_bench.h"
#include "cli/interrupts.h"
#include "cli/model_files.h"
#include "cli/naming.h"
#include "cli/progress_bar.h"
#include "cli/shared_options.h"
#include "cli/text.h"
#include "cli/usage_error.h"

namespace bspc::cli {

namespace {

struct BenchArguments : SourceArguments {
  std::string efforts = "1-9";
  std::uint64_t points = 0;
  unsigned threads = 0;
  unsigned repeat = 0;
  double seconds = 60;
  double memory = 2;
  bool tsv = false;
  bool quiet = false;
};

/// One of "3" and "5-9", or nothing.
std::vector<unsigned> effortRange(const std::string& text) {
  const auto isEffort = [](char c) { return c >= '1' && c <= '9'; };
  const bool single = text.size() == 1 && isEffort(text[0]);
  const bool range = text.size() == 3 && isEffort(text[0]) && text[1] == '-' && isEffort(text[2]);
  std::vector<unsigned> efforts;
  if (!single && !range) return efforts;
  for (char c = text.front(); c <= text.back(); ++c) {
    efforts.push_back(static_cast<unsigned>(c - '0'));
  }
  return efforts;
}

/// "1-4,9" as a list that ascends, or nothing if the text makes no sense.
std::vector<unsigned> effortList(const std::string& text) {
  std::vector<unsigned> efforts;
  for (std::size_t at = 0; at <= text.size();) {
    const std::size_t comma = std::min(text.find(',', at), text.size());
    const std::vector<unsigned> range = effortRange(text.substr(at, comma - at));
    if (range.empty()) return {};
    efforts.insert(efforts.end(), range.begin(), range.end());
    at = comma + 1;
  }
  std::sort(efforts.begin(), efforts.end());
  efforts.erase(std::unique(efforts.begin(), efforts.end()), efforts.end());
  return efforts;
}

/// As many points as there is memory for: beside what they are in memory themselves, a coding and a
/// decoding, in which arrays stand several times.
std::uint64_t pointsInMemory(const BenchArguments& args, const ModelPoints& model) {
  constexpr double kCodingBytes = 160;
  constexpr double kArrayCopies = 5;
  double bytes = 3.0 * static_cast<double>(scalarSize(model.type())) + kCodingBytes;
  for (const ArrayDescription& array : model.arrays()) {
    bytes += kArrayCopies * static_cast<double>(array.components) *
             static_cast<double>(std::max<std::size_t>(1, arrayValueSize(array.type)));
  }
  return std::max<std::uint64_t>(1, static_cast<std::uint64_t>(args.memory * (1 << 30) / bytes));
}

/// What a table says of the points that were measured.
struct Subject {
  std::uint64_t points = 0;
  std::uint64_t inputBytes = 0;  ///< 0 where it would not compare: a pipe, a part of a model
  bool isCut = false;
  unsigned threads = 0;
};

double megapoints(const Subject& subject, double seconds) {
  return static_cast<double>(subject.points) / std::max(seconds, 1e-9) / 1e6;
}

double bitsPerPoint(const EffortResult& result) {
  return 8 * static_cast<double>(result.report.fileBytes) /
         static_cast<double>(result.report.points);
}

void printTsv(const Subject& subject, const std::vector<EffortResult>& results) {
  std::cout << "effort\tmethod\tpoints\tbytes\tbits_per_point\tencode_seconds\tdecode_seconds\t"
               "threads\truns\n";
  for (const EffortResult& result : results) {
    if (result.runs() == 0) continue;
    std::cout << result.effort << '\t' << methodName(result.report.method) << '\t'
              << result.report.points << '\t' << result.report.fileBytes << '\t'
              << fixed(bitsPerPoint(result), 4) << '\t' << rounded(median(result.encodeSeconds))
              << '\t' << rounded(median(result.decodeSeconds)) << '\t' << subject.threads << '\t'
              << result.runs() << '\n';
  }
}

std::string padded(const std::string& text, std::size_t width) {
  return text.size() < width ? std::string(width - text.size(), ' ') + text : text;
}

void printHead(const BenchArguments& args, const Subject& subject, const EncodeReport& report) {
  const std::string name = args.input == "-" ? "standard input" : args.input;
  std::cout << name << ": " << (subject.isCut ? "the first " : "") << withCommas(subject.points)
            << " points";
  if (subject.inputBytes > 0) std::cout << " in " << withCommas(subject.inputBytes) << " bytes";
  std::cout << "; " << errorText(report.exact, report.maxError) << "; " << gridText(report.grid)
            << '\n'
            << "From memory to memory, threads: " << subject.threads << "; medians.\n\n";
}

void printTable(const BenchArguments& args, const Subject& subject,
                const std::vector<EffortResult>& results, const EncodeReport& report) {
  printHead(args, subject, report);
  const std::vector<std::size_t> widths{6, 12, 15, 12, 10, 14, 14, 6};
  const auto line = [&](const std::vector<std::string>& cells) {
    std::string text;
    for (std::size_t i = 0; i < cells.size(); ++i) text += padded(cells[i], widths[i]);
    std::cout << text << '\n';
  };
  line({"effort", "method", "bytes", "bits/point", "of input", "enc Mpts/s", "dec Mpts/s", "runs"});
  for (const EffortResult& result : results) {
    if (result.runs() == 0) {
      line({std::to_string(result.effort), "-", "-", "-", "-", "-", "-", "0"});
      continue;
    }
    const std::string share = subject.inputBytes == 0
                                  ? "-"
                                  : "1/" + fixed(static_cast<double>(subject.inputBytes) /
                                                     static_cast<double>(result.report.fileBytes),
                                                 2);
    line({std::to_string(result.effort), methodName(result.report.method),
          withCommas(result.report.fileBytes), fixed(bitsPerPoint(result), 3), share,
          fixed(megapoints(subject, median(result.encodeSeconds)), 3),
          fixed(megapoints(subject, median(result.decodeSeconds)), 3),
          std::to_string(result.runs())});
  }
}

/// What kept efforts from being measured, if anything did; on standard error.
void explainMissing(const BenchArguments& args, const std::vector<EffortResult>& results) {
  std::string missing;
  for (const EffortResult& result : results) {
    if (result.runs() == 0)
      missing += (missing.empty() ? "" : ", ") + std::to_string(result.effort);
  }
  if (missing.empty() || interrupted()) return;
  std::cerr << "bspc: not measured: effort " << missing << ", for the " << rounded(args.seconds)
            << " seconds of --seconds were over; --points N measures the first N points alone\n";
}

EncodeOptions encodeOptions(const BenchArguments& args, const ModelPoints& model) {
  EncodeOptions options;
  options.grid = gridRequest(args);
  options.grid.knownLattice = model.info().lattice;
  options.metadata = model.metadata();
  options.keepOrder = keepsOrder(args, model.info());
  options.originalIds = args.originalIds;
  options.threads = args.threads;
  return options;
}

void runBench(const BenchArguments& args) {
  ProgressBar reading("reading", args.quiet);
  ModelPoints model(args.input, args.from, args.content, reading.callback());
  const EncodeOptions options = encodeOptions(args, model);
  const std::uint64_t fitting = pointsInMemory(args, model);
  const WholePoints points(model, args.points != 0 ? args.points : fitting);
  reading.clear();
  if (points.size() == 0) throw Error(ErrorCode::InvalidArgument, args.input + ": has no points");

  Subject subject;
  subject.isCut = points.isCut();
  subject.threads =
      args.threads != 0 ? args.threads : std::max(1U, std::thread::hardware_concurrency());
  std::error_code error;
  if (args.input != "-" && !subject.isCut) {
    const std::uintmax_t bytes = std::filesystem::file_size(args.input, error);
    if (!error) subject.inputBytes = bytes;
  }
  const PointSetView view = points.view();
  EffortBench bench(view, options, {args.repeat, args.seconds, args.quiet});
  const std::vector<EffortResult> results =
      naming(args.input, [&] { return bench.run(effortList(args.efforts)); });
  const auto measured = std::find_if(results.begin(), results.end(),
                                     [](const EffortResult& result) { return result.runs() > 0; });
  if (measured != results.end()) {
    subject.points = measured->report.points;
    if (args.tsv) {
      printTsv(subject, results);
    } else {
      printTable(args, subject, results, measured->report);
    }
  }
  std::cout.flush();
  if (interrupted()) throw Error(ErrorCode::Cancelled, args.input + ": stopped as asked");
  if (measured == results.end()) {
    throw Error(ErrorCode::Cancelled, args.input + ": no effort was through in " +
                                          rounded(args.seconds) +
                                          " seconds; give it more --seconds or fewer --points");
  }
  explainMissing(args, results);
  if (subject.isCut && args.points == 0) {
    std::cerr << "bspc: " << args.input << " has more points than --memory " << args.memory
              << " holds; the first " << withCommas(subject.points) << " were measured\n";
  }
}

}  // namespace

void addBenchCommand(CLI::App& app) {
  constexpr auto kGroup = "Measuring";
  auto args = std::make_shared<BenchArguments>();
  CLI::App* command =
      app.add_subcommand("bench", "Measure sizes and speeds of the efforts on a model of yours");
  command
      ->add_option("input", args->input,
                   "Model: PLY, OBJ, OFF, XYZ, CSV, LAS or PCD; - reads a pipe")
      ->required();
  command->add_option("--efforts", args->efforts, "Which ones (default 1-9)")
      ->option_text("1-4,9")
      ->check([](const std::string& text) {
        return effortList(text).empty() ? "must be efforts such as 2,5-9" : std::string();
      })
      ->group(kGroup);
  command
      ->add_option("--seconds", args->seconds,
                   "Stop after so long (default 60); what was not through has no numbers")
      ->option_text("S")
      ->check(positiveNumber)
      ->group(kGroup);
  command
      ->add_option("--repeat", args->repeat,
                   "Runs of each effort, of which the median counts (default: 3, and up\n"
                   "to 100 of small models)")
      ->option_text("N")
      ->check(CLI::Range(1U, 1000U))
      ->group(kGroup);
  command->add_option("--points", args->points, "Measure the first N points alone")
      ->option_text("N")
      ->check(CLI::Range(std::uint64_t{1}, UINT64_MAX))
      ->group(kGroup);
  command
      ->add_option("--memory", args->memory,
                   "Memory to use, in GiB (default 2); of a larger model the first points\n"
                   "are measured")
      ->option_text("GIB")
      ->check(positiveNumber)
      ->group(kGroup);
  command->add_option("--threads", args->threads, "Threads (default: as many as the machine has)")
      ->option_text("N")
      ->group(kGroup);
  addGridOptions(*command, *args);
  addContentOptions(*command, *args);
  addFromOption(*command, *args);
  command->add_flag("--tsv", args->tsv, "Print tab-separated values, for programs");
  command->add_flag("-q,--quiet", args->quiet, "No progress");
  command->callback([args] { runBench(*args); });
  command->footer(
      "Each size is that of the file that `bspc encode` writes with the same options. Every file\n"
      "is decoded, and its checksums are checked. Ctrl-C ends with what was measured by then.\n\n"
      "Examples:\n"
      "  bspc bench scan.ply\n"
      "  bspc bench scan.ply --precision 0.001 --efforts 2,5,9 --threads 1\n"
      "  bspc bench huge.las --points 1000000 --tsv > efforts.tsv");
}

}  // namespace bspc::cli
