#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "bspc/grid.h"

namespace bspc::cli {

/// "1,234,567".
std::string withCommas(std::uint64_t value);
/// "%.Nf".
std::string fixed(double value, int digits);
/// The shortest text that reads back as the same double.
std::string shortest(double value);
/// A coordinate of the grid, as short as its scalar type allows.
std::string coordinateText(const Grid& grid, double value);
/// Six significant digits.
std::string rounded(double value);
/// Text that a file brings, as one line without control characters and of at most `longest` bytes.
std::string oneLine(const std::string& text, std::size_t longest);
/// "exact", or "greatest error 0.0005 (x), …" with the largest over the axes.
std::string errorText(bool exact, const std::array<double, 3>& maxError);
/// One line: "step 0.01 from (1, 2, 3), float64", "every bit of float32".
std::string gridText(const Grid& grid);

}  // namespace bspc::cli
