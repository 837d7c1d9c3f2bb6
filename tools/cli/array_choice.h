#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "bspc/arrays.h"

namespace bspc::cli {

/// The options that choose arrays by name.
struct ArrayArguments {
  std::optional<std::string> arrays;  ///< names with commas between
  std::vector<std::string> without;
  std::vector<std::string> precisions;  ///< "NAME=TOLERANCE"
};

/// The names of a list with commas between; blanks around them do not count.
std::vector<std::string> splitNames(const std::string& list);

/// Which of a model's arrays are wished for, with the tolerances that are asked for set in
/// `arrays`. Throws UsageError for names that the model does not have and tolerances that are none.
std::vector<std::size_t> chooseArrays(const ArrayArguments& args,
                                      std::vector<ArrayDescription>& arrays);

}  // namespace bspc::cli
