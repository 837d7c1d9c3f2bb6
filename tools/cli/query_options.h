#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <optional>
#include <string>

#include "bspc/decoder.h"

namespace bspc::cli {

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

}  // namespace bspc::cli
