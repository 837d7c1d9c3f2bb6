// Bits a value and speeds of the coders of arrays and of the order of points, for the points of
// whole files as one tile in the decoded order of method fast.
//
//   arrays_benchmark FILE...    FILE: .las (point format 3), .pcd (x y z rgb), .obj

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <exception>
#include <string>
#include <vector>

#include "array_sets.h"
#include "attributes/order_coder.h"
#include "geometry/geometry_method.h"

namespace {

using bspc::Bytes;
using bspc::GridPoint;
using bspc::attributes::ArrayValues;
using bspc::attributes::ArrayWishes;
using bspc::attributes::TilePoints;
using bspc::benchmarks::ArraySet;
using bspc::benchmarks::NamedArray;

constexpr std::uint64_t kPlenty = std::uint64_t{1} << 36;

/// Processor time: other programs do not count.
double seconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

std::vector<std::uint32_t> decodedOrder(const std::vector<GridPoint>& points) {
  bspc::geometry::TileInput tile;
  tile.points = points;
  for (const GridPoint& p : points) {
    for (std::size_t k = 0; k < 3; ++k) tile.extent[k] = std::max(tile.extent[k], p[k]);
  }
  return bspc::geometry::findGeometryMethod(bspc::Method::Fast)->encode(tile, {}).order;
}

ArrayValues reordered(const NamedArray& array, const std::vector<std::uint32_t>& order) {
  const std::size_t size = array.values.numbers.size() / order.size();
  ArrayValues result;
  result.numbers.resize(array.values.numbers.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    std::memcpy(result.numbers.data() + i * size, array.values.numbers.data() + order[i] * size,
                size);
  }
  return result;
}

struct Measured {
  double bits = 0;  ///< a value
  double encoded = 0;
  double decoded = 0;  ///< millions of values a second
  unsigned method = 0;
};

Measured measure(const NamedArray& array, const ArrayValues& values,
                 const std::vector<GridPoint>& points, const std::vector<std::uint32_t>* order,
                 const ArrayWishes& wishes) {
  const double count = static_cast<double>(points.size()) * array.shape.components;
  ArrayValues given = values;
  const double start = seconds();
  TilePoints forEncoder(points);
  if (order != nullptr) forEncoder.setInputOrder(*order);
  const Bytes payload = encodeArray(array.shape, given, forEncoder, wishes).payload;
  const double middle = seconds();
  TilePoints forDecoder(points);
  if (order != nullptr) forDecoder.setInputOrder(*order);
  ArrayValues back;
  decodeArray(array.shape, payload, forDecoder, kPlenty, back);
  const double end = seconds();
  if (back.numbers != given.numbers) throw std::runtime_error(array.name + " came back wrong");
  return {8 * static_cast<double>(payload.size()) / count, 1e-6 * count / (middle - start),
          1e-6 * count / (end - middle), payload[0]};
}

void print(const std::string& name, const char* way, const Measured& m) {
  std::printf("  %-16s %-22s %8.3f bits   %7.2f %7.2f Mvalues/s   method %u\n", name.c_str(), way,
              m.bits, m.encoded, m.decoded, m.method);
  std::fflush(stdout);
}

void run(const std::string& path) {
  const ArraySet set = bspc::benchmarks::readArraySet(path);
  const std::vector<std::uint32_t> order = decodedOrder(set.points);
  std::vector<GridPoint> points;
  points.reserve(order.size());
  for (const std::uint32_t i : order) points.push_back(set.points[i]);
  const auto count = static_cast<double>(points.size());
  std::printf("%s: %zu points\n", set.name.c_str(), points.size());
  const double start = seconds();
  const Bytes coded = bspc::attributes::encodeOrder(points, order);
  const double middle = seconds();
  if (bspc::attributes::decodeOrder(points, coded, kPlenty) != order) {
    throw std::runtime_error("the order came back wrong");
  }
  const double orderBits = 8 * static_cast<double>(coded.size()) / count;
  std::printf("  %-39s %8.3f bits a point, %.2f and %.2f us a point\n", "order", orderBits,
              1e6 * (middle - start) / count, 1e6 * (seconds() - middle) / count);
  double sum = orderBits;
  for (const NamedArray& array : set.arrays) {
    const ArrayValues values = reordered(array, order);
    ArrayWishes wishes;
    wishes.effort = 2;
    print(array.name, "effort 2", measure(array, values, points, nullptr, wishes));
    print(array.name, "effort 2, with order", measure(array, values, points, &order, wishes));
    wishes.effort = 5;
    print(array.name, "effort 5", measure(array, values, points, nullptr, wishes));
    wishes.effort = 9;
    const Measured best = measure(array, values, points, &order, wishes);
    print(array.name, "effort 9, with order", best);
    sum += best.bits * array.shape.components;
    if (array.shape.semantic != bspc::Semantic::Normals) continue;
    for (const double angle : {0.23, 0.058}) {
      wishes.maxAngle = angle;
      const std::string way = "effort 9, " + std::to_string(angle).substr(0, 5) + " degrees";
      print(array.name, way.c_str(), measure(array, values, points, nullptr, wishes));
    }
  }
  std::printf("  %-39s %8.3f bits a point\n\n", "order and all arrays at effort 9", sum);
}

}  // namespace

int main(int argc, char** argv) {
  int failures = 0;
  for (int i = 1; i < argc; ++i) {
    try {
      run(argv[i]);
    } catch (const std::exception& error) {
      std::fprintf(stderr, "arrays_benchmark: %s: %s\n", argv[i], error.what());
      ++failures;
    }
  }
  return failures == 0 && argc > 1 ? 0 : 1;
}
