#include "off_model.h"

#include <array>
#include <fstream>
#include <sstream>
#include <stdexcept>

namespace bspc::bench {

namespace {

/// The next line that is not empty, without comments.
bool nextLine(std::istream& in, std::istringstream& line) {
  std::string text;
  while (std::getline(in, text)) {
    text = text.substr(0, text.find('#'));
    if (text.find_first_not_of(" \t\r") == std::string::npos) continue;
    line.clear();
    line.str(text);
    return true;
  }
  return false;
}

}  // namespace

OffModel readOff(const std::string& name) {
  std::ifstream in(name);
  std::istringstream line;
  std::string keyword;
  std::size_t vertices = 0;
  std::size_t faces = 0;
  const auto bad = [&] { return std::runtime_error(name + " is no OFF file of this benchmark"); };
  if (!nextLine(in, line) || !(line >> keyword) || keyword.find("OFF") == std::string::npos) {
    throw bad();
  }
  if (!(line >> vertices) && !(nextLine(in, line) && line >> vertices)) throw bad();
  if (!(line >> faces)) throw bad();
  OffModel model;
  for (std::size_t i = 0; i < vertices; ++i) {
    std::array<double, 3> p{};
    if (!nextLine(in, line) || !(line >> p[0] >> p[1] >> p[2])) throw bad();
    for (const double x : p) model.xyz.push_back(static_cast<float>(x));
  }
  for (std::size_t i = 0; i < faces; ++i) {
    std::size_t corners = 0;
    if (!nextLine(in, line) || !(line >> corners)) throw bad();
    std::vector<std::uint32_t> face(corners);
    for (std::uint32_t& v : face) {
      if (!(line >> v) || v >= vertices) throw bad();
    }
    model.cells.faces.add(face);
  }
  return model;
}

OffModel inTriangles(const OffModel& model) {
  OffModel cut;
  cut.xyz = model.xyz;
  for (std::size_t i = 0; i < model.cells.faces.size(); ++i) {
    const Span<const std::uint32_t> face = model.cells.faces[i];
    for (std::size_t j = 2; j < face.size(); ++j) {
      cut.cells.faces.add(std::vector<std::uint32_t>{face[0], face[j - 1], face[j]});
    }
  }
  return cut;
}

std::string baseName(const std::string& path) { return path.substr(path.rfind('/') + 1); }

}  // namespace bspc::bench
