#pragma once

#include <string>
#include <vector>

namespace bspc::paper {

// Each prints a table of the models in these files, decodes and compares every coding, and returns
// 0 if all of them hold the very points of their grids, else 1.

/// Mean bits per point, and times, of the models of each size.
int table2(const std::vector<std::string>& files);
/// Bits per point of each model.
int table3(const std::vector<std::string>& files);

}  // namespace bspc::paper
