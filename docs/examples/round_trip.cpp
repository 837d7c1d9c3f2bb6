// Compresses a few points, looks at what was written, and gets them back.
#include <bspc/decoder.h>
#include <bspc/encoder.h>
#include <bspc/error.h>

#include <fstream>
#include <iostream>
#include <memory>
#include <vector>

namespace {

void compress(const std::vector<float>& xyz, const char* path) {
  std::ofstream file(path, std::ios::binary);
  bspc::StreamSink sink(file);
  bspc::EncodeOptions options;  // exact where the points lie on a lattice, else float precision
  options.grid = bspc::GridRequest::withPrecision(0.001);
  const bspc::EncodeReport report =
      bspc::encode(bspc::PointSetView(xyz.data(), xyz.size() / 3), sink, options);
  std::cout << report.points << " points in " << report.fileBytes << " bytes, greatest error in x "
            << report.maxError[0] << '\n';
}

std::vector<float> restore(const char* path) {
  std::ifstream file(path, std::ios::binary);
  bspc::Decoder decoder(std::make_shared<bspc::StreamSource>(file));
  const bspc::DecodedPoints decoded = decoder.decode();  // in the coder's order, not the input's
  std::vector<float> xyz(3 * decoded.points.size());
  bspc::restorePositions(decoder.info().grid, decoded, xyz.data());
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
    for (int i = 0; i < 1000; ++i) {
      const auto t = static_cast<float>(i) / 1000;
      xyz.insert(xyz.end(), {t, t * t, 1 - t});
    }
    compress(xyz, argv[1]);
    const std::vector<float> restored = restore(argv[1]);
    std::cout << restored.size() / 3 << " points came back\n";
    return restored.size() == xyz.size() ? 0 : 1;
  } catch (const bspc::Error& error) {
    std::cerr << bspc::errorCodeName(error.code()) << ": " << error.what() << '\n';
    return 1;
  }
}
