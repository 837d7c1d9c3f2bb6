#include "formats/obj_reader.h"

#include <algorithm>
#include <array>
#include <string>
#include <string_view>
#include <utility>

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
  explicit ObjStream(InputBuffer in) : in_(std::move(in)), text_(in_) { info_.type = kTextType; }

  std::size_t read(std::uint8_t* positions, std::size_t count) override {
    std::size_t done = 0;
    std::string_view keyword;
    while (done < count && text_.nextLine()) {
      const bool isContinuation = continued_;
      text_.cutComment('#');
      continued_ = text_.endsWith('\\');
      if (isContinuation || !text_.nextToken(keyword)) continue;
      if (keyword == "v") {
        if (continued_) text_.fail("a vertex that goes on in the next line is not supported");
        storePosition(positions, done++, readVertex());
      } else {
        countStatement(keyword);
      }
    }
    if (done < count && info_.otherContent.empty()) nameOtherContent();
    return done;
  }

 private:
  std::array<double, 3> readVertex() {
    std::array<double, 3> position{};
    std::string_view token;
    for (std::size_t k = 0; k < 3; ++k) {
      if (!text_.nextToken(token)) text_.failAtEnd(std::string("a vertex without ") + "xyz"[k]);
      position[k] = text_.number<double>(token, [k] { return std::string(1, "xyz"[k]); });
    }
    if (text_.nextToken(token)) readFurther(token);
    return position;
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
      ++colours_;
    } else if (first != 1) {
      ++weights_;
    }
  }

  void countStatement(std::string_view keyword) {
    const auto* const found =
        std::find_if(kStatements.begin(), kStatements.end(),
                     [&](const Statement& s) { return s.keyword == keyword; });
    if (found == kStatements.end()) {
      text_.fail("expected a statement of an OBJ file such as v, found " + quoted(keyword));
    }
    ++counts_[static_cast<std::size_t>(found - kStatements.begin())];
  }

  void nameOtherContent() {
    std::vector<std::string>& content = info_.otherContent;
    if (colours_ > 0) content.push_back(counted(colours_, "vertex colour", "vertex colours"));
    if (weights_ > 0) content.push_back(counted(weights_, "vertex weight", "vertex weights"));
    for (std::size_t i = 0; i < kStatements.size(); ++i) {
      if (counts_[i] == 0 || *kStatements[i].one == '\0') continue;
      content.push_back(counted(counts_[i], kStatements[i].one, kStatements[i].many));
    }
  }

  InputBuffer in_;
  TextScanner text_;
  /// Whether the last line goes on in the next.
  bool continued_ = false;
  std::array<std::uint64_t, kStatements.size()> counts_{};
  std::uint64_t colours_ = 0;
  std::uint64_t weights_ = 0;
};

}  // namespace

std::unique_ptr<PointStream> openObj(InputBuffer in) {
  return std::make_unique<ObjStream>(std::move(in));
}

}  // namespace bspc::formats
