#include "cli/model_files.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "bspc/error.h"
#include "cli/input_file.h"
#include "cli/naming.h"
#include "cli/usage_error.h"
#include "formats/array_tuples.h"
#include "formats/wording.h"

namespace bspc::cli {

namespace {

std::string lowerCaseEnding(const std::string& path) {
  const std::size_t dot = path.rfind('.');
  return dot == std::string::npos ? "" : formats::lowerCase(path.substr(dot + 1));
}

std::optional<formats::Format> formatOf(const std::string& name, const std::string& path) {
  return formats::formatFromPath(name.empty() ? path : "." + name);
}

/// Names what a file has that nobody allowed to leave out.
void refuseContent(const std::string& name, const ContentArguments& args,
                   const std::vector<formats::OtherContent>& content) {
  if (args.positionsOnly || args.dropOther) return;
  std::string list;
  constexpr std::size_t kNamed = 6;
  std::size_t named = 0;
  bool onlyFaces = true;
  for (const formats::OtherContent& item : content) {
    const bool isFaces = item.kind == formats::OtherContent::Kind::Connectivity;
    if (isFaces && args.noFaces) continue;
    onlyFaces = onlyFaces && isFaces;
    if (named < kNamed) list += (named > 0 ? ", " : "") + item.phrase;
    if (named == kNamed) list += ", …";
    ++named;
  }
  if (named == 0) return;
  throw Error(ErrorCode::Unsupported,
              name + ": has more than points, faces and the points' arrays (" + list +
                  "), which this version cannot store; " +
                  (onlyFaces ? "--no-faces" : "--drop-other") +
                  " leaves that out, --positions-only everything but positions");
}

}  // namespace

formats::Format chooseInputFormat(const std::string& name, const std::string& path) {
  if (const auto format = formatOf(name, path)) return *format;
  throw UsageError(path + ": cannot tell the format from the name; say it with --from " +
                   "ply, obj, off, xyz, csv, las or pcd");
}

formats::Format chooseOutputFormat(const std::string& name, const std::string& path) {
  if (lowerCaseEnding(name.empty() ? path : "." + name) == "laz") {
    throw UsageError(path +
                     ": LAZ files are not written; write LAS and compress it, for example "
                     "by laszip or pdal translate");
  }
  if (const auto format = formatOf(name, path)) return *format;
  throw UsageError(path + ": cannot tell the format from the name; say it with --to " +
                   "ply, obj, off, xyz, csv, las or pcd");
}

namespace {

/// Runs `work` on the model file called `name`; errors leave with that name in front.
template <class Work>
auto namingModel(const std::string& name, Work work) {
  try {
    return naming(name, work);
  } catch (const formats::FormatError& error) {
    throw Error(ErrorCode::Io, name + ": " + error.what());
  }
}

}  // namespace

formats::Model readModelFile(const std::string& path, const std::string& formatName,
                             const ProgressCallback& progress) {
  const formats::Format format = chooseInputFormat(formatName, path);
  InputFile input(path);
  return namingModel(input.name(),
                     [&] { return formats::readModel(input.stream(), format, progress, true); });
}

ModelPoints::ModelPoints(const std::string& path, const std::string& formatName,
                         const ContentArguments& content, const ProgressCallback& progress)
    : format_(chooseInputFormat(formatName, path)),
      input_(path),
      content_(content),
      keepsMesh_(!content.positionsOnly && !content.noFaces) {
  stream_ = namingModel(
      input_.name(), [&] { return formats::openPointStream(input_.stream(), format_, progress); });
  if (keepsMesh_) stream_->keepMesh();
  refuseOther();
  if (!content.positionsOnly) chooseFrom(stream_->info().arrays);
}

void ModelPoints::chooseFrom(const std::vector<ArrayDescription>& arrays) {
  std::vector<ArrayDescription> described = arrays;
  try {
    chosen_ = chooseArrays(content_.arrays, described);
  } catch (const UsageError& error) {
    throw UsageError(input_.name() + ": " + error.what());
  }
  for (const std::size_t a : chosen_) arrays_.push_back(described[a]);
  all_ = formats::emptyArrays(arrays);
}

void ModelPoints::refuseOther() const {
  refuseContent(input_.name(), content_, stream_->info().otherContent);
}

Metadata ModelPoints::metadata() const {
  Metadata metadata;
  if (!content_.positionsOnly) metadata = stream_->info().metadata;
  if (!content_.crs.empty()) metadata.crs = content_.crs;
  return metadata;
}

std::size_t ModelPoints::read(std::uint8_t* xyz, Span<ArrayValues> values, std::size_t count) {
  if (ended_) return 0;
  try {
    const std::size_t got =
        namingModel(input_.name(), [&] { return readChosen(xyz, values, count); });
    ended_ = got < count;
    if (ended_) refuseOther();
    return got;
  } catch (const Error& error) {
    // The encoder that asks for points would put the name in front once more.
    throw NamedError(error.code(), error.what());
  }
}

/// The file's arrays are read together; those that are kept lend their memory for it.
std::size_t ModelPoints::readChosen(std::uint8_t* xyz, Span<ArrayValues> values,
                                    std::size_t count) {
  if (chosen_.empty()) return stream_->read(xyz, {}, count);
  const auto exchange = [&] {
    for (std::size_t a = 0; a < chosen_.size(); ++a) {
      std::swap(all_[chosen_[a]].values, values[a].values);
      std::swap(all_[chosen_[a]].strings, values[a].strings);
    }
  };
  exchange();
  const std::size_t got = stream_->read(xyz, all_, count);
  exchange();
  for (ArrayValues& array : all_) {
    array.values.clear();
    array.strings.clear();
  }
  return got;
}

WholePoints::WholePoints(ModelPoints& points, std::uint64_t most)
    : type_(points.type()), values_(formats::emptyArrays(points.arrays())) {
  constexpr std::uint64_t kBlock = std::uint64_t{1} << 16;
  const std::size_t pointBytes = 3 * scalarSize(type_);
  for (std::size_t got = 1; got > 0 && size() < most;) {
    const std::size_t before = positions_.size();
    const auto wanted = static_cast<std::size_t>(std::min(kBlock, most - size()));
    positions_.resize(before + wanted * pointBytes);
    got = points.read(positions_.data() + before, values_, wanted);
    positions_.resize(before + got * pointBytes);
  }
  if (!points.ended()) {
    std::vector<std::uint8_t> further(pointBytes);
    std::vector<ArrayValues> values = formats::emptyArrays(points.arrays());
    isCut_ = points.read(further.data(), values, 1) > 0;
  }
  if (!isCut_) mesh_ = points.takeMesh();
}

PointSetView WholePoints::view() const {
  PointSetView view(positions_.data(), type_, size(), 0);
  for (const ArrayValues& array : values_) view.addArray(array.view());
  if (!mesh_.empty()) view.setMesh(&mesh_);
  return view;
}

}  // namespace bspc::cli
