#include "formats/off_reader.h"

#include <array>
#include <cstring>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "formats/array_tuples.h"
#include "formats/position_text.h"
#include "formats/text_scanner.h"
#include "formats/wording.h"

namespace bspc::formats {

namespace {

class OffStream : public PointStream {
 public:
  explicit OffStream(InputBuffer in) : in_(std::move(in)), text_(in_) {
    info_.type = kTextType;
    readKeyword();
    vertices_ = expectCount("vertices");
    faces_ = expectCount("faces");
    skipNumbers("the number of edges");
    mayHaveMesh_ = faces_ > 0;
    if (vertices_ > 0) lookForArrays();
    // In text a vertex takes six bytes at the least.
    reservable_ = in_.reservable(vertices_, 6);
  }

  std::size_t read(std::uint8_t* positions, Span<ArrayValues> values, std::size_t count) override {
    std::size_t done = 0;
    for (; done < count && index_ < vertices_; ++done, ++index_) {
      storePosition(positions, done, readVertex(values));
    }
    if (done < count) finish();
    return done;
  }

 private:
  void finish() {
    if (finished_) return;
    for (index_ = 0; index_ < faces_; ++index_) readFace();
    index_ = vertices_;
    std::string_view token;
    if (next(token)) text_.fail("trailing data after the last face: " + quoted(token));
    nameOtherContent();
    finished_ = true;
  }

  /// What the keyword promises, if the first vertex has as many numbers in its line.
  void lookForArrays() {
    std::string_view token;
    if (!next(token)) return;
    std::size_t further = 0;
    for (std::size_t numbers = 1; text_.nextToken(token); ++numbers) further += numbers < 3 ? 0 : 1;
    text_.rewindLine();
    const std::size_t others = (hasNormals_ ? 3U : 0U) + (hasTexture_ ? 2U : 0U);
    if (further < others) return;
    const std::size_t colours = further - others;
    if (hasColours_ ? colours != 3 && colours != 4 : colours != 0) return;
    if (hasNormals_) addArray("Normals", Semantic::Normals, {"nx", "ny", "nz"});
    if (colours == 3) addArray("RGB", Semantic::Colours, {"red", "green", "blue"});
    if (colours == 4) addArray("RGBA", Semantic::Colours, {"red", "green", "blue", "alpha"});
    if (hasTexture_) addArray("TextureCoordinates", Semantic::TextureCoordinates, {"s", "t"});
  }

  void addArray(const char* name, Semantic semantic, std::vector<std::string> components) {
    ArrayDescription array;
    array.name = name;
    array.type = kTextType;
    array.components = static_cast<std::uint32_t>(components.size());
    array.componentNames = std::move(components);
    array.semantic = semantic;
    info_.arrays.push_back(std::move(array));
  }

  /// The next token of this line or a later one, comments left out.
  bool next(std::string_view& token) {
    while (!text_.nextToken(token)) {
      if (!text_.nextLine()) return false;
      text_.cutComment('#');
    }
    return true;
  }

  /// [ST][C][N]OFF, in front of the counts or on a line of its own.
  void readKeyword() {
    std::string_view token;
    if (!next(token)) text_.failAtEnd("expected \"OFF\", found nothing");
    std::string_view left = token;
    if (left.substr(0, 2) == "ST") {
      hasTexture_ = true;
      left.remove_prefix(2);
    }
    if (left.substr(0, 1) == "C") {
      hasColours_ = true;
      left.remove_prefix(1);
    }
    if (left.substr(0, 1) == "N") {
      hasNormals_ = true;
      left.remove_prefix(1);
    }
    if (left == "4OFF" || left == "nOFF" || left == "4nOFF") {
      text_.fail("an OFF file of other than three dimensions (" + quoted(token) +
                 ") is not supported");
    }
    if (left != "OFF") text_.fail("expected \"OFF\", found " + quoted(token));
  }

  std::uint64_t expectCount(const char* what) {
    const std::string name = std::string("the number of ") + what;
    std::string_view token;
    if (!next(token)) text_.failAtEnd("the file ends before " + name);
    if (token == "BINARY") text_.fail("a binary OFF file is not supported; convert it to text");
    return text_.number<std::uint64_t>(token, [&]() -> const std::string& { return name; });
  }

  /// Numbers up to the end of the line; how many.
  std::size_t skipNumbers(const char* what) {
    std::size_t count = 0;
    std::string_view token;
    for (; text_.nextToken(token); ++count) {
      text_.number<double>(token, [what] { return std::string(what); });
    }
    return count;
  }

  std::array<double, 3> readVertex(Span<ArrayValues> values) {
    std::array<double, 3> position{};
    std::string_view token;
    for (std::size_t k = 0; k < 3; ++k) {
      if (!next(token)) failShort("vertex", vertices_);
      position[k] = text_.number<double>(
          token, [&] { return std::string(1, "xyz"[k]) + " of " + place("vertex", vertices_); });
    }
    if (!info_.arrays.empty() && !values.empty()) {
      readArrays(values);
    } else if (skipNumbers("a vertex") > 0 && info_.arrays.empty()) {
      ++further_;
    }
    return position;
  }

  void readArrays(Span<ArrayValues> values) {
    std::string_view token;
    for (std::size_t a = 0; a < info_.arrays.size(); ++a) {
      std::array<double, 4> tuple{};
      const std::size_t components = info_.arrays[a].components;
      for (std::size_t k = 0; k < components; ++k) {
        if (!text_.nextToken(token)) text_.failAtEnd("a vertex with less numbers than the first");
        tuple[k] = text_.number<double>(token, [] { return std::string("a vertex"); });
      }
      std::memcpy(appendTuples(values[a], 1), tuple.data(), components * sizeof(double));
    }
    if (text_.nextToken(token)) text_.fail("a vertex with more numbers than the first");
  }

  /// Its number of corners, their vertices, perhaps a colour to the end of the line.
  void readFace() {
    std::string_view token;
    if (!next(token)) failShort("face", faces_);
    const auto corners = text_.number<std::uint64_t>(
        token, [&] { return "the number of corners of " + place("face", faces_); });
    face_.clear();
    for (std::uint64_t i = 0; i < corners; ++i) {
      if (!next(token)) failShort("face", faces_);
      const auto vertex = text_.number<std::uint64_t>(
          token, [&] { return "a corner of " + place("face", faces_); });
      if (vertex >= vertices_) {
        text_.fail("a corner of " + place("face", faces_) + " is vertex " + grouped(vertex) +
                   ", counted from 0, of only " + grouped(vertices_));
      }
      if (keepsMesh_) face_.push_back(static_cast<std::uint32_t>(vertex));
    }
    if (keepsMesh_) mesh_.faces.add(face_);
    if (text_.nextToken(token)) ++colouredFaces_;
    while (text_.nextToken(token)) {
    }
  }

  std::string place(const char* what, std::uint64_t count) const {
    return std::string(what) + " " + grouped(index_ + 1) + " of " + grouped(count);
  }

  [[noreturn]] void failShort(const char* what, std::uint64_t count) const {
    text_.failAtEnd("the file ends inside " + place(what, count));
  }

  void nameOtherContent() {
    using Kind = OtherContent::Kind;
    std::vector<OtherContent>& content = info_.otherContent;
    if (further_ > 0) {
      content.push_back(
          {"further numbers of " + counted(further_, "vertex", "vertices"), Kind::Rest});
    }
    if (!keepsMesh_) {
      if (faces_ > 0) content.push_back({counted(faces_, "face", "faces"), Kind::Connectivity});
    } else if (colouredFaces_ > 0) {
      content.push_back({"colours of " + counted(colouredFaces_, "face", "faces"), Kind::Rest});
    }
  }

  InputBuffer in_;
  TextScanner text_;
  bool finished_ = false;
  bool hasTexture_ = false;
  bool hasColours_ = false;
  bool hasNormals_ = false;
  std::uint64_t vertices_ = 0;
  std::uint64_t faces_ = 0;
  std::uint64_t further_ = 0;
  std::uint64_t colouredFaces_ = 0;
  std::vector<std::uint32_t> face_;
  std::uint64_t index_ = 0;
};

}  // namespace

std::unique_ptr<PointStream> openOff(InputBuffer in) {
  return std::make_unique<OffStream>(std::move(in));
}

}  // namespace bspc::formats
