#include "vtkBSPReader.h"

#include <algorithm>
#include <functional>
#include <limits>
#include <new>
#include <vtksys/SystemInformation.hxx>
#include <vtksys/SystemTools.hxx>

#include "bspc/decoder.h"
#include "bspc/error.h"
#include "vtkBSPReader/opened_file.h"
#include "vtkBSPReader/piece_options.h"
#include "vtkBSPReader/poly_data_builder.h"
#include "vtkDataArraySelection.h"
#include "vtkErrorCode.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkMath.h"
#include "vtkObjectFactory.h"
#include "vtkPolyData.h"
#include "vtkStreamingDemandDrivenPipeline.h"
#include "vtkVersionMacros.h"
#include "vtk_support/error_codes.h"

vtkStandardNewMacro(vtkBSPReader);

namespace {

using bspc::DecodeOptions;
using bspc::Decoder;
using bspc::FileInfo;

/// The level of that number, or the finest there is: files of a series have more and less of them.
unsigned levelOr(int level, unsigned finest) {
  return level < 0 ? finest : std::min(static_cast<unsigned>(level), finest);
}

/// The greatest coordinate that a point of that index can have.
double greatestCoordinate(const bspc::Grid& grid, int axis, std::uint32_t i) {
  // Of exact float64 an index is the upper half only.
  const bool shared = grid.form == bspc::Grid::Form::FloatBits &&
                      grid.scalarType == bspc::ScalarType::Float64 &&
                      i < std::numeric_limits<std::uint32_t>::max();
  return bspc::restoredCoordinate(grid, axis, shared ? i + 1 : i);
}

/// What decoding may take whatever the limit of the output.
constexpr std::uint64_t kLeastMemory = std::uint64_t{64} << 20;

std::uint64_t memoryBytes(vtkIdType mebibytes) {
  if (mebibytes > 0) return static_cast<std::uint64_t>(mebibytes) << 20;
  // In KiB.
  return static_cast<std::uint64_t>(vtksys::SystemInformation().GetHostMemoryTotal()) << 10;
}

}  // namespace

/// What needs the library's types, which the header keeps to itself.
class vtkBSPReader::vtkInternals {
 public:
  explicit vtkInternals(vtkBSPReader* self) : self_(self) {}

  /// Runs the body of a request; what goes wrong becomes a VTK error. Returns what a request does.
  int Run(const std::function<void()>& body);
  Decoder Open() const;
  void Publish(const FileInfo& info, vtkInformation* outInfo);
  void Read(Decoder& decoder, vtkInformation* outInfo, vtkPolyData* output);

 private:
  DecodeOptions OptionsOf(const FileInfo& info) const;
  bool WantsMesh(const FileInfo& info) const;
  bool Aborted();

  vtkBSPReader* self_;
};

int vtkBSPReader::vtkInternals::Run(const std::function<void()>& body) {
  const auto fail = [this](unsigned long code, const std::string& what) {
    self_->SetErrorCode(code);
    const std::string where = self_->ReadFromInputString ? "" : std::string(self_->FileName) + ": ";
    vtkErrorWithObjectMacro(self_, << where << what);
    return 0;
  };
  self_->SetErrorCode(vtkErrorCode::NoError);
  if (!self_->ReadFromInputString) {
    if (self_->FileName == nullptr || *self_->FileName == '\0') {
      self_->SetErrorCode(vtkErrorCode::NoFileNameError);
      vtkErrorWithObjectMacro(self_, "no file name is set");
      return 0;
    }
    if (!vtksys::SystemTools::FileExists(self_->FileName)) {
      return fail(vtkErrorCode::FileNotFoundError, "there is no such file");
    }
    if (!vtksys::SystemTools::FileExists(self_->FileName, true)) {
      return fail(vtkErrorCode::CannotOpenFileError, "is a folder, not a file");
    }
  }
  try {
    body();
    return 1;
  } catch (const bspc::Error& error) {
    return fail(bspc::vtk::vtkErrorCodeOf(error.code()), error.what());
  } catch (const std::bad_alloc&) {
    return fail(vtkErrorCode::UnknownError, "the points and arrays do not fit into memory");
  }
}

Decoder vtkBSPReader::vtkInternals::Open() const {
  bspc::OpenOptions options;
  options.allowPartial = self_->AllowPartial;
  // Nothing is decoded for which the output has no room, but for what a tile takes on the way.
  options.limits.memoryBytes =
      std::min(options.limits.memoryBytes, std::max(memoryBytes(self_->MemoryLimit), kLeastMemory));
  return self_->ReadFromInputString ? bspc::vtk::openBytes(self_->InputString, options)
                                    : bspc::vtk::openFile(self_->FileName, options);
}

void vtkBSPReader::vtkInternals::Publish(const FileInfo& info, vtkInformation* outInfo) {
  self_->NumberOfPointsInFile = static_cast<vtkIdType>(info.points);
  self_->NumberOfTiles = static_cast<vtkIdType>(info.tiles.size());
  self_->PointsOfLevels.clear();
  for (const bspc::LayerInfo& layer : info.layers) {
    self_->PointsOfLevels.push_back(static_cast<vtkIdType>(layer.points));
  }
  std::vector<const char*> names;
  for (const bspc::ArrayInfo& array : info.arrays) names.push_back(array.name.c_str());
  self_->PointDataArraySelection->SetArrays(names.data(), static_cast<int>(names.size()));

  vtkMath::UninitializeBounds(self_->BoundsOfFile);
  if (info.points > 0) {
    for (int axis = 0; axis < 3; ++axis) {
      const auto k = static_cast<std::size_t>(axis);
      self_->BoundsOfFile[2 * k] = bspc::restoredCoordinate(info.grid, axis, info.lower[k]);
      self_->BoundsOfFile[2 * k + 1] = greatestCoordinate(info.grid, axis, info.upper[k]);
    }
    outInfo->Set(vtkStreamingDemandDrivenPipeline::BOUNDS(), self_->BoundsOfFile, 6);
  } else {
    outInfo->Remove(vtkStreamingDemandDrivenPipeline::BOUNDS());
  }
  outInfo->Set(vtkAlgorithm::CAN_HANDLE_PIECE_REQUEST(), 1);
}

/// Whether all points are read of a file that has cells for them.
bool vtkBSPReader::vtkInternals::WantsMesh(const FileInfo& info) const {
  const int finest = static_cast<int>(info.layers.size()) - 1;
  const bool all = self_->LevelOfDetail < 0 || self_->LevelOfDetail >= finest;
  const vtkIdType most = self_->MaximumNumberOfPoints;
  const bool fits = most == 0 || static_cast<vtkIdType>(info.points) <= most;
  return !info.mesh.empty() && !info.mesh.missing && all && fits && !self_->UseBox;
}

DecodeOptions vtkBSPReader::vtkInternals::OptionsOf(const FileInfo& info) const {
  DecodeOptions options;
  // The finest is not asked for by its number: a file that was cut short may lack it.
  const int finest = static_cast<int>(info.layers.size()) - 1;
  if (self_->LevelOfDetail >= 0 && self_->LevelOfDetail < finest) {
    options.level = static_cast<unsigned>(self_->LevelOfDetail);
  }
  if (self_->MaximumNumberOfPoints > 0) {
    options.maxPoints = static_cast<std::uint64_t>(self_->MaximumNumberOfPoints);
  }
  options.wantCounts = self_->GeneratePointCounts;
  options.arrays.emplace();
  for (const bspc::ArrayInfo& array : info.arrays) {
    if (self_->GetPointArrayStatus(array.name.c_str()) != 0) options.arrays->push_back(array.name);
  }
  if (self_->UseBox) {
    const double* box = self_->Box;
    options.box = bspc::Box{{box[0], box[2], box[4]}, {box[1], box[3], box[5]}};
  }
  options.threads = static_cast<unsigned>(self_->NumberOfThreads);
  return options;
}

void vtkBSPReader::vtkInternals::Read(Decoder& decoder, vtkInformation* outInfo,
                                      vtkPolyData* output) {
  using Pipeline = vtkStreamingDemandDrivenPipeline;
  int piece = 0;
  int pieces = 1;
  if (outInfo->Has(Pipeline::UPDATE_NUMBER_OF_PIECES()) != 0) {
    piece = outInfo->Get(Pipeline::UPDATE_PIECE_NUMBER());
    pieces = outInfo->Get(Pipeline::UPDATE_NUMBER_OF_PIECES());
  }
  const FileInfo& info = decoder.info();
  DecodeOptions options = OptionsOf(info);
  const unsigned level = decoder.cost(options).level;
  if (self_->GenerateCellIds) options.cellLevel = levelOr(self_->CellIdLevel, level);
  const bool mesh = WantsMesh(info);
  // Cells come with the whole set only, which is the first piece.
  if (mesh && piece > 0) {
    output->Initialize();
    return;
  }
  if (mesh) pieces = 1;
  options = bspc::vtk::optionsOfPiece(decoder, options, static_cast<std::uint64_t>(piece),
                                      static_cast<std::uint64_t>(pieces));
  options.progress = [this](double share) {
    self_->UpdateProgress(share);
    return !Aborted();
  };

  bspc::vtk::PolyDataBuilder::Options building;
  for (const bspc::ArrayInfo& array : info.arrays) {
    const bool chosen = self_->GetPointArrayStatus(array.name.c_str()) != 0;
    if (chosen && array.firstLevel <= level) building.arrays.push_back(array);
  }
  building.cellIds = self_->GenerateCellIds;
  building.counts = self_->GeneratePointCounts;
  building.vertices = self_->GenerateVertices;
  building.memoryBytes = memoryBytes(self_->MemoryLimit);
  bspc::vtk::PolyDataBuilder builder(info, building);
  try {
    if (mesh) {
      const bspc::DecodedPoints whole = decoder.decode(options);
      builder.append(whole);
      builder.finish(output, &whole);
      return;
    }
    decoder.decodeTiles(options, [&builder](bspc::DecodedPoints&& tile) { builder.append(tile); });
  } catch (const bspc::Error& error) {
    // Asked to stop: nothing has gone wrong, and there is no output.
    if (error.code() == bspc::ErrorCode::Cancelled) return;
    throw;
  }
  builder.finish(output);
}

bool vtkBSPReader::vtkInternals::Aborted() {
#if VTK_VERSION_NUMBER >= VTK_VERSION_CHECK(9, 2, 20221008)
  return self_->CheckAbort();
#else
  return self_->GetAbortExecute() != 0;
#endif
}

vtkBSPReader::vtkBSPReader()
    : PointDataArraySelection(vtkSmartPointer<vtkDataArraySelection>::New()) {
  vtkMath::UninitializeBounds(this->BoundsOfFile);
}

vtkBSPReader::~vtkBSPReader() = default;

int vtkBSPReader::CanReadFile(const char* fileName) {
  return fileName != nullptr && bspc::vtk::beginsAsBspc(fileName) ? 1 : 0;
}

void vtkBSPReader::SetInputString(const std::string& bytes) {
  this->InputString = bytes;
  this->Modified();
}

void vtkBSPReader::SetInputString(const char* bytes, vtkIdType count) {
  this->SetInputString(bytes != nullptr ? std::string(bytes, static_cast<std::size_t>(count))
                                        : std::string());
}

int vtkBSPReader::RequestInformation(vtkInformation* vtkNotUsed(request),
                                     vtkInformationVector** vtkNotUsed(inputVector),
                                     vtkInformationVector* outputVector) {
  vtkInternals internals(this);
  return internals.Run(
      [&] { internals.Publish(internals.Open().info(), outputVector->GetInformationObject(0)); });
}

int vtkBSPReader::RequestData(vtkInformation* vtkNotUsed(request),
                              vtkInformationVector** vtkNotUsed(inputVector),
                              vtkInformationVector* outputVector) {
  vtkInternals internals(this);
  vtkInformation* outInfo = outputVector->GetInformationObject(0);
  return internals.Run([&] {
    Decoder decoder = internals.Open();
    internals.Read(decoder, outInfo, vtkPolyData::GetData(outInfo));
  });
}

int vtkBSPReader::GetNumberOfPointArrays() {
  return this->PointDataArraySelection->GetNumberOfArrays();
}

const char* vtkBSPReader::GetPointArrayName(int index) {
  return this->PointDataArraySelection->GetArrayName(index);
}

int vtkBSPReader::GetPointArrayStatus(const char* name) {
  return this->PointDataArraySelection->ArrayIsEnabled(name);
}

void vtkBSPReader::SetPointArrayStatus(const char* name, int status) {
  this->PointDataArraySelection->SetArraySetting(name, status);
}

vtkDataArraySelection* vtkBSPReader::GetPointDataArraySelection() {
  return this->PointDataArraySelection;
}

int vtkBSPReader::GetNumberOfLevels() { return static_cast<int>(this->PointsOfLevels.size()); }

vtkIdType vtkBSPReader::GetNumberOfPointsOfLevel(int level) {
  const auto index = static_cast<std::size_t>(level);
  return level >= 0 && index < this->PointsOfLevels.size() ? this->PointsOfLevels[index] : 0;
}

vtkMTimeType vtkBSPReader::GetMTime() {
  return std::max(this->Superclass::GetMTime(), this->PointDataArraySelection->GetMTime());
}

void vtkBSPReader::PrintSelf(ostream& os, vtkIndent indent) {
  this->Superclass::PrintSelf(os, indent);
  os << indent << "ReadFromInputString: " << this->ReadFromInputString << '\n';
  os << indent << "LevelOfDetail: " << this->LevelOfDetail << '\n';
  os << indent << "MaximumNumberOfPoints: " << this->MaximumNumberOfPoints << '\n';
  os << indent << "UseBox: " << this->UseBox << '\n';
  os << indent << "Box:";
  for (const double bound : this->Box) os << ' ' << bound;
  os << '\n';
  os << indent << "GenerateVertices: " << this->GenerateVertices << '\n';
  os << indent << "GenerateCellIds: " << this->GenerateCellIds << '\n';
  os << indent << "CellIdLevel: " << this->CellIdLevel << '\n';
  os << indent << "GeneratePointCounts: " << this->GeneratePointCounts << '\n';
  os << indent << "AllowPartial: " << this->AllowPartial << '\n';
  os << indent << "NumberOfThreads: " << this->NumberOfThreads << '\n';
  os << indent << "MemoryLimit: " << this->MemoryLimit << '\n';
  os << indent << "NumberOfPointsInFile: " << this->NumberOfPointsInFile << '\n';
  os << indent << "PointDataArraySelection:\n";
  this->PointDataArraySelection->PrintSelf(os, indent.GetNextIndent());
}
