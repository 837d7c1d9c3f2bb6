#include "paper_support.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <memory>
#include <stdexcept>

#include "benchmark_support.h"
#include "bspc/decoder.h"
#include "formats/model_io.h"

namespace bspc::paper {

namespace {

bool alreadyGridded(const GridFit& fit) {
  std::uint32_t longest = 0;
  for (const GridPoint& p : fit.points) longest = std::max({longest, p[0], p[1], p[2]});
  return fit.exact && longest < (1U << kBits);
}

}  // namespace

GriddedModel readGridded(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  const std::optional<formats::Format> format = formats::formatFromPath(path);
  if (!in || !format) throw std::runtime_error(path + ": cannot be read");
  GriddedModel model;
  model.name = path.substr(path.find_last_of('/') + 1);
  try {
    const formats::Model source = formats::readModel(in, *format);
    GridFit fit = fitGrid(source.view(), GridRequest::automatic());
    if (!alreadyGridded(fit)) fit = fitGrid(source.view(), GridRequest::withBits(kBits));
    model.points = std::move(fit.points);
  } catch (const std::exception& error) {
    throw std::runtime_error(path + ": " + error.what());
  }
  if (model.points.empty()) throw std::runtime_error(path + ": holds no points");
  for (const GridPoint& p : model.points) {
    for (const std::uint32_t v : p) model.xyz.push_back(static_cast<std::int32_t>(v));
  }
  return model;
}

Coding codeAndDecode(const GriddedModel& model, const EncodeOptions& wishes) {
  EncodeOptions options = wishes;
  options.layers = 1;
  options.wantOrder = true;
  // The model's own grid, so that nothing but the coding moves a point.
  Grid grid;
  grid.scalarType = ScalarType::Int32;
  options.grid = GridRequest::onGrid(grid);
  Coding coding;
  MemorySink sink;
  EncodeReport report;
  coding.encodeSeconds = secondsOf([&] { report = encode(model.view(), sink, options); });
  Decoder decoder(std::make_shared<MemorySource>(sink.bytes()));
  DecodeOptions asked;
  asked.cellLevel = 0;
  DecodedPoints decoded;
  coding.decodeSeconds = secondsOf([&] { decoded = decoder.decode(asked); });
  std::vector<std::int32_t> back(3 * decoded.points.size());
  restorePositions(decoder.info().grid, Span<const GridPoint>(decoded.points), back.data());

  coding.fileBytes = report.fileBytes;
  const auto count = static_cast<double>(model.points.size());
  coding.bitsPerPoint = 8 * static_cast<double>(report.fileBytes) / count;
  coding.restored.resize(model.points.size());
  coding.cell.resize(model.points.size());
  double squares = 0;
  for (std::size_t j = 0; j < decoded.points.size(); ++j) {
    const std::uint64_t i = report.order[j];
    double square = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      coding.restored[i][k] = static_cast<std::uint32_t>(back[3 * j + k]);
      const double d = back[3 * j + k] - static_cast<double>(model.points[i][k]);
      square += d * d;
    }
    coding.cell[i] = decoded.cellIds[j];
    coding.cells = std::max(coding.cells, decoded.cellIds[j] + 1);
    squares += square;
    coding.greatest = std::max(coding.greatest, std::sqrt(square));
  }
  coding.rms = std::sqrt(squares / count);
  return coding;
}

EncodeOptions stopAtLevel(Method method, unsigned level) {
  EncodeOptions options;
  options.method = method;
  options.stopLevel = level;
  return options;
}

EncodeOptions stopAtPoints(Method method, std::uint64_t points) {
  EncodeOptions options;
  options.method = method;
  options.stopPoints = points;
  return options;
}

std::vector<Coding> codeEveryLevel(const GriddedModel& model, Method method) {
  std::vector<Coding> levels;
  constexpr unsigned kMost = 300;
  for (unsigned level = 0; level < kMost; ++level) {
    levels.push_back(codeAndDecode(model, stopAtLevel(method, level)));
    if (levels.back().exact()) break;
  }
  return levels;
}

}  // namespace bspc::paper
