#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <optional>
#include <string>

#include "bspc/decoder.h"
#include "bspc/grid.h"
#include "cli/model_files.h"
#include "formats/model.h"

namespace bspc::cli {

// Options that several commands have.

/// The options that choose a part of a file.
struct QueryArguments {
  std::optional<unsigned> level;
  std::optional<std::uint64_t> maxPoints;
  std::string box;

  bool any() const { return level || maxPoints || !box.empty(); }
};

/// `args` must live as long as the command.
void addQueryOptions(CLI::App& command, QueryArguments& args);

/// What they ask of a decoder. Throws UsageError for a box that is none.
DecodeOptions decodeOptions(const QueryArguments& args);

/// What the user asks of a model on its way to an encoder.
struct SourceArguments {
  std::string input;
  std::string from;
  std::string grid = "auto";
  unsigned bits = 0;
  double precision = 0;
  bool exact = false;
  ContentArguments content;
  bool keepOrder = false;
  bool anyOrder = false;
  bool originalIds = false;
  bool dropNonFinite = false;
};

/// Each adds options, in a group of the same name.
void addGridOptions(CLI::App& command, SourceArguments& args);
void addContentOptions(CLI::App& command, SourceArguments& args);
void addFromOption(CLI::App& command, SourceArguments& args);

/// Checks a number of an option: empty if it is finite and above 0, else what it must be.
std::string positiveNumber(const std::string& text);

/// Throws UsageError for wishes that exclude each other, Error if the file of a grid is none.
GridRequest gridRequest(const SourceArguments& args);

/// Whether the order of the points is to be kept; the rows of an organised cloud are only rows in
/// their order. Throws UsageError for wishes that exclude each other.
bool keepsOrder(const SourceArguments& args, const formats::ModelInfo& info);

}  // namespace bspc::cli
