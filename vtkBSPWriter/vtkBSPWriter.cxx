#include "vtkBSPWriter.h"

#include <algorithm>
#include <functional>
#include <new>
#include <optional>

#include "bspc/encoder.h"
#include "bspc/error.h"
#include "vtkBSPWriter/input_points.h"
#include "vtkBSPWriter/output_sinks.h"
#include "vtkDataArraySelection.h"
#include "vtkErrorCode.h"
#include "vtkInformation.h"
#include "vtkObjectFactory.h"
#include "vtkVersionMacros.h"
#include "vtk_support/error_codes.h"
#include "vtk_support/field_data.h"

vtkStandardNewMacro(vtkBSPWriter);

/// What needs the library's types, which the header keeps to itself.
class vtkBSPWriter::vtkInternals {
 public:
  explicit vtkInternals(vtkBSPWriter* self) : self_(self) {}

  void WriteToString();
  void WriteToFile();
  void Fail(unsigned long code, const std::string& what);

 private:
  void Encode(bspc::ByteSink& sink);
  bspc::EncodeOptions Options() const;
  bspc::GridRequest Grid() const;
  bspc::vtk::InputPoints::Options InputOptions() const;
  bool Aborted();

  vtkBSPWriter* self_;
};

void vtkBSPWriter::vtkInternals::Fail(unsigned long code, const std::string& what) {
  self_->SetErrorCode(code);
  const bool named = !self_->WriteToOutputString && self_->FileName != nullptr;
  vtkErrorWithObjectMacro(self_, << (named ? std::string(self_->FileName) + ": " : "") << what);
}

bspc::GridRequest vtkBSPWriter::vtkInternals::Grid() const {
  bspc::GridRequest request;
  switch (self_->GridMode) {
    case BITS:
      request = bspc::GridRequest::withBits(static_cast<unsigned>(self_->Bits));
      break;
    case PRECISION:
      request = bspc::GridRequest::withPrecision(self_->Precision);
      break;
    case EXACT:
      throw bspc::Error(bspc::ErrorCode::Unsupported,
                        "coordinates cannot be kept bit for bit yet; use another GridMode");
    default:
      break;
  }
  request.dropNonFinite = self_->DropNonFinite;
  return request;
}

bspc::EncodeOptions vtkBSPWriter::vtkInternals::Options() const {
  bspc::EncodeOptions options;
  options.grid = Grid();
  if (self_->Method != nullptr && *self_->Method != '\0') {
    options.method = bspc::methodFromName(self_->Method);
    if (!options.method) {
      throw bspc::Error(bspc::ErrorCode::InvalidArgument,
                        "there is no method \"" + std::string(self_->Method) + "\"");
    }
  }
  if (self_->Effort > 0) options.effort = static_cast<unsigned>(self_->Effort);
  options.keepOrder = self_->KeepOrder;
  options.layers = static_cast<unsigned>(self_->NumberOfLevels);
  options.tilePoints = static_cast<std::uint64_t>(self_->PointsPerTile);
  options.threads = static_cast<unsigned>(self_->NumberOfThreads);
  options.layout = self_->Layout == STREAMING ? bspc::Layout::Streaming : bspc::Layout::Progressive;
  options.metadata = bspc::vtk::metadataOf(self_->GetInput()->GetFieldData());
  return options;
}

bspc::vtk::InputPoints::Options vtkBSPWriter::vtkInternals::InputOptions() const {
  bspc::vtk::InputPoints::Options options;
  options.dropCells = self_->DropCells;
  options.wantsArray = [this](const char* name) { return self_->GetPointArrayStatus(name) != 0; };
  options.tolerances = self_->ArrayTolerances;
  return options;
}

void vtkBSPWriter::vtkInternals::Encode(bspc::ByteSink& sink) {
  const bspc::vtk::InputPoints points(self_->GetInput(), InputOptions());
  bspc::EncodeOptions options = Options();
  options.progress = [this](double share) {
    self_->UpdateProgress(share);
    return !Aborted();
  };
  const bspc::EncodeReport report = bspc::encode(points.view(), sink, options);
  self_->NumberOfPointsWritten = static_cast<vtkIdType>(report.points);
  self_->NumberOfBytesWritten = static_cast<vtkIdType>(report.fileBytes);
  self_->Exact = report.exact;
  std::copy(report.maxError.begin(), report.maxError.end(), self_->MaximumError);
}

void vtkBSPWriter::vtkInternals::WriteToString() {
  bspc::vtk::StringSink sink;
  Encode(sink);
  self_->OutputString = sink.take();
  self_->Written = true;
}

void vtkBSPWriter::vtkInternals::WriteToFile() {
  std::optional<bspc::vtk::FileSink> file;
  try {
    file.emplace(self_->FileName);
  } catch (const bspc::Error& error) {
    Fail(vtkErrorCode::CannotOpenFileError, error.what());
    return;
  }
  try {
    Encode(*file);
    file->commit();
    self_->Written = true;
  } catch (const bspc::Error& error) {
    if (!file->diskFull()) throw;
    Fail(vtkErrorCode::OutOfDiskSpaceError, error.what());
  }
}

bool vtkBSPWriter::vtkInternals::Aborted() {
#if VTK_VERSION_NUMBER >= VTK_VERSION_CHECK(9, 2, 20221008)
  return self_->CheckAbort();
#else
  return self_->GetAbortExecute() != 0;
#endif
}

vtkBSPWriter::vtkBSPWriter()
    : PointDataArraySelection(vtkSmartPointer<vtkDataArraySelection>::New()) {
  this->PointDataArraySelection->SetUnknownArraySetting(1);
}

vtkBSPWriter::~vtkBSPWriter() {
  delete[] this->FileName;
  delete[] this->Method;
}

int vtkBSPWriter::FillInputPortInformation(int vtkNotUsed(port), vtkInformation* info) {
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkPointSet");
  info->Append(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkTable");
  return 1;
}

int vtkBSPWriter::Write() {
  this->Written = false;
  this->SetErrorCode(vtkErrorCode::NoError);
  // The pipeline refuses inputs of other types without telling its caller.
  return this->Superclass::Write() != 0 && this->Written ? 1 : 0;
}

void vtkBSPWriter::WriteData() {
  vtkInternals internals(this);
  this->Written = false;
  this->OutputString.clear();
  if (!this->WriteToOutputString && (this->FileName == nullptr || *this->FileName == '\0')) {
    internals.Fail(vtkErrorCode::NoFileNameError, "no file name is set");
    return;
  }
  try {
    if (this->WriteToOutputString) {
      internals.WriteToString();
    } else {
      internals.WriteToFile();
    }
  } catch (const bspc::Error& error) {
    // Asked to stop: nothing has gone wrong, and nothing is written.
    if (error.code() == bspc::ErrorCode::Cancelled) return;
    internals.Fail(bspc::vtk::vtkErrorCodeOf(error.code()), error.what());
  } catch (const std::bad_alloc&) {
    internals.Fail(vtkErrorCode::UnknownError, "there is not enough memory to compress the points");
  }
}

vtkDataArraySelection* vtkBSPWriter::GetPointDataArraySelection() {
  return this->PointDataArraySelection;
}

int vtkBSPWriter::GetPointArrayStatus(const char* name) {
  return this->PointDataArraySelection->ArrayIsEnabled(name);
}

void vtkBSPWriter::SetPointArrayStatus(const char* name, int status) {
  this->PointDataArraySelection->SetArraySetting(name, status);
}

void vtkBSPWriter::SetArrayTolerance(const char* name, double tolerance) {
  if (name == nullptr) return;
  this->ArrayTolerances[name] = tolerance;
  this->Modified();
}

double vtkBSPWriter::GetArrayTolerance(const char* name) {
  const auto found = this->ArrayTolerances.find(name != nullptr ? name : "");
  return found != this->ArrayTolerances.end() ? found->second : 0;
}

void vtkBSPWriter::ClearArrayTolerances() {
  this->ArrayTolerances.clear();
  this->Modified();
}

vtkMTimeType vtkBSPWriter::GetMTime() {
  return std::max(this->Superclass::GetMTime(), this->PointDataArraySelection->GetMTime());
}

void vtkBSPWriter::PrintSelf(ostream& os, vtkIndent indent) {
  this->Superclass::PrintSelf(os, indent);
  os << indent << "FileName: " << (this->FileName != nullptr ? this->FileName : "(none)") << '\n';
  os << indent << "WriteToOutputString: " << this->WriteToOutputString << '\n';
  os << indent << "GridMode: " << this->GridMode << '\n';
  os << indent << "Bits: " << this->Bits << '\n';
  os << indent << "Precision: " << this->Precision << '\n';
  os << indent << "Effort: " << this->Effort << '\n';
  os << indent << "Method: " << (this->Method != nullptr ? this->Method : "(none)") << '\n';
  os << indent << "KeepOrder: " << this->KeepOrder << '\n';
  os << indent << "Layout: " << this->Layout << '\n';
  os << indent << "NumberOfLevels: " << this->NumberOfLevels << '\n';
  os << indent << "PointsPerTile: " << this->PointsPerTile << '\n';
  os << indent << "DropCells: " << this->DropCells << '\n';
  os << indent << "DropNonFinite: " << this->DropNonFinite << '\n';
  os << indent << "NumberOfThreads: " << this->NumberOfThreads << '\n';
  for (const auto& [name, tolerance] : this->ArrayTolerances) {
    os << indent << "Tolerance of " << name << ": " << tolerance << '\n';
  }
  os << indent << "PointDataArraySelection:\n";
  this->PointDataArraySelection->PrintSelf(os, indent.GetNextIndent());
}
