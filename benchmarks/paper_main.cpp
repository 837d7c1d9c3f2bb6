// The tables and curves of the paper, from models that are given as files:
//   paper table2 MODEL...      bits per point and times by the number of points
//   paper table3 MODEL...      bits per point of the four partitions, model by model
//   paper rate MODEL [METHOD]  bits per point and error, level by level
//   paper distortion MODEL     rate against error where cells with few points stay undivided
//   paper figures MODEL FOLDER points coloured by cell, as PLY files

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <fstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "cell_pictures.h"
#include "paper_support.h"
#include "paper_tables.h"

namespace bspc::paper {
namespace {

void printRow(const char* label, std::uint64_t value, const Coding& coding) {
  std::printf("%6s %6llu %9llu %10.3f %10.3f %10.3f\n", label,
              static_cast<unsigned long long>(value), static_cast<unsigned long long>(coding.cells),
              coding.bitsPerPoint, coding.rms, coding.greatest);
}

void printHead(const GriddedModel& model, const char* method) {
  std::printf("\n%s, %zu points, method %s; errors in grid steps\n", model.name.c_str(),
              model.points.size(), method);
  std::printf("%6s %6s %9s %10s %10s %10s\n", "stop", "at", "cells", "bits/point", "RMS",
              "greatest");
}

int rate(const std::string& file, const std::string& methodText) {
  const std::optional<Method> method = methodFromName(methodText);
  if (!method) throw std::runtime_error("there is no method " + methodText);
  const GriddedModel model = readGridded(file);
  printHead(model, methodText.c_str());
  const std::vector<Coding> levels = codeEveryLevel(model, *method);
  for (std::size_t level = 0; level < levels.size(); ++level) {
    printRow("level", level, levels[level]);
  }
  return 0;
}

int distortion(const std::string& file) {
  const GriddedModel model = readGridded(file);
  for (const Method method : {Method::Bsp, Method::Kd}) {
    printHead(model, methodName(method));
    EncodeOptions lossless;
    lossless.method = method;
    printRow("points", 0, codeAndDecode(model, lossless));
    for (std::uint64_t points = 1; points < 2 * model.points.size(); points *= 2) {
      printRow("points", points, codeAndDecode(model, stopAtPoints(method, points)));
    }
  }
  return 0;
}

int figures(const std::string& file, const std::string& folder) {
  const GriddedModel model = readGridded(file);
  const std::vector<Coding> levels = codeEveryLevel(model, Method::Bsp);
  // Figure 1's rates; the other figures show one level after the other.
  constexpr double kRates[] = {1.3, 4.1, 8.5, 15.3};
  std::vector<ColouredCells> sideBySide;
  // File, bits per point and cells of each, for paper_pictures.py.
  std::ofstream list(folder + "/rates.txt");
  for (const double wished : kRates) {
    std::size_t best = 0;
    for (std::size_t level = 1; level < levels.size(); ++level) {
      if (std::abs(levels[level].bitsPerPoint - wished) <
          std::abs(levels[best].bitsPerPoint - wished)) {
        best = level;
      }
    }
    sideBySide.push_back({&model, &levels[best]});
    const std::string name = "rate_" + std::to_string(sideBySide.size());
    std::string path = folder;
    path.append("/").append(name);
    writeColoured(path + ".ply", {sideBySide.back()});
    writeColoured(path + "_restored.ply", {{&model, &levels[best], true}});
    list << name << '\t' << std::round(10 * levels[best].bitsPerPoint) / 10 << '\t'
         << levels[best].cells << '\n';
    std::printf("%4.1f bits per point: level %zu, %.2f bits per point, %llu cells\n", wished, best,
                levels[best].bitsPerPoint, static_cast<unsigned long long>(levels[best].cells));
  }
  list.close();
  if (!list) throw std::runtime_error(folder + "/rates.txt: cannot be written");
  writeColoured(folder + "/rates.ply", sideBySide);
  constexpr unsigned kShown = 12;
  for (unsigned level = 0; level < std::min<std::size_t>(kShown, levels.size()); ++level) {
    std::string path = folder + (level < 10 ? "/level_0" : "/level_");
    path.append(std::to_string(level)).append(".ply");
    writeColoured(path, {{&model, &levels[level]}});
  }
  std::printf("%s/rates.ply: the four rates side by side; %s/level_NN.ply: level by level\n",
              folder.c_str(), folder.c_str());
  return 0;
}

int run(const std::vector<std::string>& words) {
  const std::string& what = words.empty() ? std::string() : words[0];
  const std::size_t more = words.empty() ? 0 : words.size() - 1;
  if (what == "table2" && more >= 1) return table2({words.begin() + 1, words.end()});
  if (what == "table3" && more >= 1) return table3({words.begin() + 1, words.end()});
  if (what == "rate" && more >= 1 && more <= 2) return rate(words[1], more == 2 ? words[2] : "bsp");
  if (what == "distortion" && more == 1) return distortion(words[1]);
  if (what == "figures" && more == 2) return figures(words[1], words[2]);
  std::fputs(
      "Usage: paper table2|table3 MODEL... | rate MODEL [bsp|kd] | distortion MODEL | "
      "figures MODEL FOLDER\n",
      stderr);
  return 2;
}

}  // namespace
}  // namespace bspc::paper

int main(int argc, char** argv) {
  try {
    return bspc::paper::run({argv + 1, argv + argc});
  } catch (const std::exception& error) {
    std::fprintf(stderr, "paper: %s\n", error.what());
    return 1;
  }
}
