// Compresses a few points with a colour each, looks at what was written, and gets them back.
#include <bspc/decoder.h>
#include <bspc/encoder.h>
#include <bspc/error.h>

#include <cstdint>
#include <fstream>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

namespace {

void compress(const std::vector<float>& xyz, const std::vector<std::uint8_t>& rgb,
              const char* path) {
  bspc::ArrayView colours;  // views your memory, which may be interleaved
  colours.name = "Colours";
  colours.type = bspc::ScalarType::UInt8;
  colours.components = 3;
  colours.semantic = bspc::Semantic::Colours;
  colours.tuples = rgb.size() / 3;
  colours.data = rgb.data();
  bspc::PointSetView points(xyz.data(), xyz.size() / 3);
  points.addArray(colours);

  bspc::EncodeOptions options;  // exact where the points lie on a lattice, else float precision
  options.grid = bspc::GridRequest::withPrecision(0.001);
  options.metadata.crs = "EPSG:25832";
  std::ofstream file(path, std::ios::binary);
  bspc::StreamSink sink(file);
  const bspc::EncodeReport report = bspc::encode(points, sink, options);
  std::cout << report.points << " points in " << report.fileBytes << " bytes, greatest error in x "
            << report.maxError[0] << '\n';
}

std::vector<float> restore(const char* path) {
  std::ifstream file(path, std::ios::binary);
  bspc::Decoder decoder(std::make_shared<bspc::StreamSource>(file));
  bspc::DecodeOptions query;
  query.arrays = std::vector<std::string>{"Colours"};         // no other is read from disk
  const bspc::DecodedPoints decoded = decoder.decode(query);  // in the coder's order
  std::vector<float> xyz(3 * decoded.points.size());
  bspc::restorePositions(decoder.info().grid, decoded, xyz.data());
  const bspc::ArrayValues& colours = decoded.arrays[0];  // one tuple a point, in that order too
  std::cout << colours.values.size() << " bytes of " << colours.name << '\n';
  return xyz;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::cerr << "Usage: round_trip FILE.bspc\n";
    return 2;
  }
  try {
    std::vector<float> xyz;
    std::vector<std::uint8_t> rgb;
    for (int i = 0; i < 1000; ++i) {
      const auto t = static_cast<float>(i) / 1000;
      xyz.insert(xyz.end(), {t, t * t, 1 - t});
      const auto shade = static_cast<std::uint8_t>(i / 4);
      rgb.insert(rgb.end(), {shade, shade, 255});
    }
    compress(xyz, rgb, argv[1]);
    const std::vector<float> restored = restore(argv[1]);
    std::cout << restored.size() / 3 << " points came back\n";
    return restored.size() == xyz.size() ? 0 : 1;
  } catch (const bspc::Error& error) {
    std::cerr << bspc::errorCodeName(error.code()) << ": " << error.what() << '\n';
    return 1;
  }
}
