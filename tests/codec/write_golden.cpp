// Writes the golden files that differ from those of Testing/Data/frozen_1.0 into the folder given
// (Testing/Data/golden), and removes others from it. To be run only when what the encoder writes
// changes on purpose, with a line in CHANGELOG.md.

#include <cstdio>
#include <fstream>

#include "codec/golden_files.h"

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fputs("usage: write_golden FOLDER\n", stderr);
    return 2;
  }
  for (const bspc::test::GoldenFile& file : bspc::test::goldenFiles()) {
    const bspc::Bytes bytes = bspc::test::encodeGolden(file, nullptr);
    const std::string path = std::string(argv[1]) + "/" + file.name + ".bspc";
    if (bytes == bspc::test::readGolden(BSPC_TEST_DATA "/frozen_1.0/" + file.name + ".bspc")) {
      std::remove(path.c_str());
      continue;
    }
    std::ofstream out(path, std::ios::binary);
    out.write(reinterpret_cast<const char*>(bytes.data()),
              static_cast<std::streamsize>(bytes.size()));
    if (!out) {
      std::fprintf(stderr, "cannot write %s\n", path.c_str());
      return 1;
    }
  }
  return 0;
}
