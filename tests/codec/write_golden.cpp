// Writes the golden files into the folder given. To be run only when the format changes on
// purpose, with a line in CHANGELOG.md.

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
