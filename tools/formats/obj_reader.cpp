#include "formats/obj_reader.h"

#include <algorithm>
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

/// A statement whose content a model does not take along.
struct Statement {
  std::string_view keyword;
  /// How to count it; empty where it only names or groups what other statements bring.
  const char* one;
  const char* many;
};

constexpr std::array<Statement, 41> kStatements{{
    {"f", "face", "faces"},
    {"fo", "face", "faces"},
    {"vn", "normal", "normals"},
    {"vt", "texture coordinate", "texture coordinates"},
    {"l", "line", "lines"},
    {"p", "point element", "point elements"},
    {"vp", "parameter space vertex", "parameter space vertices"},
    {"curv", "curve", "curves"},
    {"curv2", "curve", "curves"},
    {"surf", "surface", "surfaces"},
    {"g", "", ""},
    {"o", "", ""},
    {"s", "", ""},
    {"mg", "", ""},
    {"usemtl", "", ""},
    {"mtllib", "", ""},
    {"usemap", "", ""},
    {"maplib", "", ""},
    {"cstype", "", ""},
    {"deg", "", ""},
    {"bmat", "", ""},
    {"step", "", ""},
    {"parm", "", ""},
    {"trim", "", ""},
    {"hole", "", ""},
    {"scrv", "", ""},
    {"sp", "", ""},
    {"end", "", ""},
    {"con", "", ""},
    {"bevel", "", ""},
    {"c_interp", "", ""},
    {"d_interp", "", ""},
    {"lod", "", ""},
    {"shadow_obj", "", ""},
    {"trace_obj", "", ""},
    {"ctech", "", ""},
    {"stech", "", ""},
    {"call", "", ""},
    {"csh", "", ""},
    {"bzp", "surface", "surfaces"},
    {"bsp", "surface", "surfaces"},
}};

class ObjStream : public PointStream {
 public:
  explicit ObjStream(InputBuffer in) : in_(std::move(in)), text_(in_) {
    info_.type = kTextType;
    mayHaveMesh_ = true;
    atVertex_ = nextVertex();
    if (atVertex_) lookForColour();
  }

  std::size_t read(std::uint8_t* positions, Span<ArrayValues> values, std::size_t count) override {
    std::size_t done = 0;
    for (; done < count && atVertex_; ++done) {
      storePosition(positions, done, readVertex(values));
      ++vertices_;
      atVertex_ = nextVertex();
    }
    if (done < count && !finished_) finish();
    return done;
  }

 private:
  /// Moves to the numbers of the next vertex; false at the end.
  bool nextVertex() {
    std::string_view keyword;
    while (text_.nextLine()) {
      const bool isContinuation = continued_;
      text_.cutComment('#');
      continued_ = text_.endsWith('\\');
      if (isContinuation || !text_.nextToken(keyword)) continue;
      if (keyword != "v") {
        countStatement(keyword);
        continue;
      }
      if (continued_) text_.fail("a vertex that goes on in the next line is not supported");
      return true;
    }
    return false;
  }

  /// Whether the vertices have colours shows in the first: three or four numbers more.
  void lookForColour() {
    std::string_view token;
    std::size_t numbers = 0;
    while (text_.nextToken(token)) ++numbers;
    text_.rewindLine();
    text_.nextToken(token);
    if (numbers != 6 && numbers != 7) return;
    ArrayDescription colours;
    colours.name = numbers == 6 ? "RGB" : "RGBA";
    colours.type = kTextType;
    colours.components = static_cast<std::uint32_t>(numbers) - 3;
    colours.componentNames = {"red", "green", "blue"};
    if (numbers == 7) colours.componentNames.emplace_back("alpha");
    colours.semantic = Semantic::Colours;
    info_.arrays.push_back(std::move(colours));
  }

  std::array<double, 3> readVertex(Span<ArrayValues> values) {
    std::array<double, 3> position{};
    std::string_view token;
    for (std::size_t k = 0; k < 3; ++k) {
      if (!text_.nextToken(token)) text_.failAtEnd(std::string("a vertex without ") + "xyz"[k]);
      position[k] = text_.number<double>(token, [k] { return std::string(1, "xyz"[k]); });
    }
    if (!info_.arrays.empty() && !values.empty()) {
      readColour(values);
    } else if (text_.nextToken(token)) {
      readFurther(token);
    }
    return position;
  }

  void readColour(Span<ArrayValues> values) {
    const std::size_t components = info_.arrays.front().components;
    std::array<double, 4> colour{};
    std::string_view token;
    std::size_t numbers = 0;
    for (; text_.nextToken(token); ++numbers) {
      if (numbers == components) text_.fail("a vertex with more numbers than the first one");
      colour[numbers] = text_.number<double>(token, [] { return std::string("a vertex colour"); });
    }
    if (numbers < components) text_.failAtEnd("a vertex with less numbers than the first one");
    std::memcpy(appendTuples(values[0], 1), colour.data(), components * sizeof(double));
  }

  /// One further number is a weight, of which 1 says nothing; three or four are a colour.
  void readFurther(std::string_view token) {
    std::size_t numbers = 0;
    double first = 0;
    do {
      const auto value = text_.number<double>(token, [] { return std::string("a vertex"); });
      if (numbers == 0) first = value;
      ++numbers;
    } while (text_.nextToken(token));
    if (numbers > 1) {
      colours_ += info_.arrays.empty() ? 1 : 0;
    } else if (first != 1) {
      ++weights_;
    }
  }

  void finish() {
    for (const Cells* cells : {&mesh_.faces, &mesh_.lines, &mesh_.vertices}) {
      for (const std::uint32_t vertex : cells->indices) {
        if (vertex < vertices_) continue;
        throw FormatError("a face, line or point element names vertex " +
                          grouped(std::uint64_t{vertex} + 1) + " of only " + grouped(vertices_));
      }
    }
    nameOtherContent();
    finished_ = true;
  }

  /// The cells that statements of this keyword bring, if they are wanted.
  Cells* cellsOf(std::string_view keyword) {
    if (!keepsMesh_) return nullptr;
    if (keyword == "f" || keyword == "fo") return &mesh_.faces;
    if (keyword == "l") return &mesh_.lines;
    return keyword == "p" ? &mesh_.vertices : nullptr;
  }

  /// References such as 7, 7/1/2 or -1; what stands behind a slash belongs to other content.
  void readCell(Cells& cells) {
    if (continued_) text_.fail("a face that goes on in the next line is not supported");
    cell_.clear();
    std::string_view token;
    while (text_.nextToken(token)) {
      const std::string_view number = token.substr(0, token.find('/'));
      const auto reference =
          text_.number<std::int64_t>(number, [] { return std::string("a vertex of a face"); });
      const std::int64_t vertex =
          reference < 0 ? static_cast<std::int64_t>(vertices_) + reference : reference - 1;
      if (vertex < 0 || vertex > kMostVertices) {
        text_.fail("there is no vertex " + quoted(number) + " here");
      }
      cell_.push_back(static_cast<std::uint32_t>(vertex));
    }
    cells.add(cell_);
  }

  void countStatement(std::string_view keyword) {
    const auto* const found =
        std::find_if(kStatements.begin(), kStatements.end(),
                     [&](const Statement& s) { return s.keyword == keyword; });
    if (found == kStatements.end()) {
      text_.fail("expected a statement of an OBJ file such as v, found " + quoted(keyword));
    }
    if (Cells* cells = cellsOf(keyword)) {
      readCell(*cells);
    } else {
      ++counts_[static_cast<std::size_t>(found - kStatements.begin())];
    }
  }

  void nameOtherContent() {
    std::vector<OtherContent>& content = info_.otherContent;
    using Kind = OtherContent::Kind;
    if (colours_ > 0) {
      content.push_back({counted(colours_, "vertex colour", "vertex colours"), Kind::Rest});
    }
    if (weights_ > 0) {
      content.push_back({counted(weights_, "vertex weight", "vertex weights"), Kind::Rest});
    }
    for (std::size_t i = 0; i < kStatements.size(); ++i) {
      const Statement& statement = kStatements[i];
      if (counts_[i] == 0 || *statement.one == '\0') continue;
      const bool connects = statement.keyword == "f" || statement.keyword == "fo" ||
                            statement.keyword == "l" || statement.keyword == "p";
      content.push_back({counted(counts_[i], statement.one, statement.many),
                         connects ? Kind::Connectivity : Kind::Rest});
    }
  }

  InputBuffer in_;
  TextScanner text_;
  /// Whether the line is a vertex that has not been read yet.
  bool atVertex_ = false;
  /// Whether the last line goes on in the next.
  bool continued_ = false;
  std::array<std::uint64_t, kStatements.size()> counts_{};
  std::uint64_t colours_ = 0;
  std::uint64_t weights_ = 0;
  static constexpr std::int64_t kMostVertices = 0xFFFFFFEF;
  std::uint64_t vertices_ = 0;
  bool finished_ = false;
  std::vector<std::uint32_t> cell_;
};

}  // namespace

std::unique_ptr<PointStream> openObj(InputBuffer in) {
  return std::make_unique<ObjStream>(std::move(in));
}

}  // namespace bspc::formats
