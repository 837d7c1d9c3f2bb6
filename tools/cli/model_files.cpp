#include "cli/model_files.h"

#include <optional>

#include "bspc/error.h"
#include "cli/input_file.h"
#include "cli/naming.h"
#include "cli/usage_error.h"

namespace bspc::cli {

namespace {

std::optional<formats::Format> formatOf(const std::string& name, const std::string& path) {
  return formats::formatFromPath(name.empty() ? path : "." + name);
}

void refuseOtherContent(const std::string& name, const std::vector<std::string>& content) {
  std::string list;
  constexpr std::size_t kNamed = 6;
  for (std::size_t i = 0; i < content.size() && i < kNamed; ++i) {
    list += (i > 0 ? ", " : "") + content[i];
  }
  if (content.size() > kNamed) list += ", …";
  throw Error(ErrorCode::Unsupported,
              name + ": has more than positions (" + list +
                  "), which this version cannot store; use --positions-only to leave it out");
}

}  // namespace

formats::Format chooseInputFormat(const std::string& name, const std::string& path) {
  if (const auto format = formatOf(name, path)) return *format;
  throw UsageError(path + ": cannot tell the format from the name; say it with --from " +
                   "ply, obj, off, xyz, csv, las or pcd");
}

formats::Format chooseOutputFormat(const std::string& name, const std::string& path) {
  const std::string known = "--to ply, obj, off, xyz or csv";
  const auto format = formatOf(name, path);
  if (!format) {
    throw UsageError(path + ": cannot tell the format from the name; say it with " + known);
  }
  if (formats::isWritable(*format)) return *format;
  throw UsageError(path + ": files of this format are read but not written; write another with " +
                   known);
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
                             bool positionsOnly, const ProgressCallback& progress) {
  const formats::Format format = chooseInputFormat(formatName, path);
  InputFile input(path);
  formats::Model model = namingModel(
      input.name(), [&] { return formats::readModel(input.stream(), format, progress); });
  if (!positionsOnly && !model.otherContent.empty()) {
    refuseOtherContent(input.name(), model.otherContent);
  }
  return model;
}

ModelPoints::ModelPoints(const std::string& path, const std::string& formatName, bool positionsOnly,
                         const ProgressCallback& progress)
    : format_(chooseInputFormat(formatName, path)), input_(path), positionsOnly_(positionsOnly) {
  stream_ = namingModel(
      input_.name(), [&] { return formats::openPointStream(input_.stream(), format_, progress); });
  refuseOther();
}

void ModelPoints::refuseOther() const {
  const std::vector<std::string>& content = stream_->info().otherContent;
  if (!positionsOnly_ && !content.empty()) refuseOtherContent(input_.name(), content);
}

std::size_t ModelPoints::read(std::uint8_t* xyz, Span<ArrayValues> /*values*/, std::size_t count) {
  if (ended_) return 0;
  try {
    const std::size_t got = namingModel(input_.name(), [&] { return stream_->read(xyz, count); });
    ended_ = got < count;
    if (ended_) refuseOther();
    return got;
  } catch (const Error& error) {
    // The encoder that asks for points would put the name in front once more.
    throw NamedError(error.code(), error.what());
  }
}

}  // namespace bspc::cli
