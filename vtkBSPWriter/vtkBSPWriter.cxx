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

namespace {

/// What a map has for that name; 0 if nothing.
double valueOf(const std::map<std::string, double>& values, const char* name) {
  const auto found = values.find(name != nullptr ? name : "");
  return found != values.end() ? found->second : 0;
}

}  // namespace

/// What needs the library's types, which the header keeps to itself.
class vtkBSPWriter::vtkInternals {
 public:
  explicit vtkInternals(vtkBSPWriter* self) : self_(self) {}

  void WriteToString();
  void WriteToFile();
  void Fail(unsigned long code, const std::string& what);
  bspc::GridRequest Grid() const;
  bspc::vtk::InputPoints::Options InputOptions() const;
  bool Aborted();

 private:
  void Encode(bspc::ByteSink& sink);

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
      request = bspc::GridRequest::exactFloats();
      break;
    default:
      break;
  }
  request.dropNonFinite = self_->DropNonFinite;
  return request;
}

bspc::vtk::InputPoints::Options vtkBSPWriter::vtkInternals::InputOptions() const {
  bspc::vtk::InputPoints::Options options;
  options.dropCells = self_->DropCells;
  options.wantsArray = [this](const char* name) { return self_->GetPointArrayStatus(name) != 0; };
  options.tolerances = self_->ArrayTolerances;
  return options;
}

void vtkBSPWriter::vtkInternals::Encode(bspc::ByteSink& sink) {
  const std::unique_ptr<bspc::vtk::InputPoints> points = self_->ReadInput();
  self_->Report(bspc::encode(points->view(), sink, self_->MakeEncodeOptions()));
}

void vtkBSPWriter::vtkInternals::WriteToString() {
  bspc::vtk::StringSink sink;
  Encode(sink);
  self_->OutputString = sink.take();
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
  this->Guard([this, &internals] {
    if (this->WriteToOutputString) {
      internals.WriteToString();
    } else {
      internals.WriteToFile();
    }
  });
}

void vtkBSPWriter::Guard(const std::function<void()>& body) {
  vtkInternals internals(this);
  try {
    body();
    this->Written = this->GetErrorCode() == vtkErrorCode::NoError;
  } catch (const bspc::Error& error) {
    // Asked to stop: nothing has gone wrong, and nothing is written.
    if (error.code() == bspc::ErrorCode::Cancelled) return;
    internals.Fail(bspc::vtk::vtkErrorCodeOf(error.code()), error.what());
  } catch (const std::bad_alloc&) {
    internals.Fail(vtkErrorCode::UnknownError, "there is not enough memory to compress the points");
  }
}

std::unique_ptr<bspc::vtk::InputPoints> vtkBSPWriter::ReadInput() {
  return std::make_unique<bspc::vtk::InputPoints>(this->GetInput(),
                                                  vtkInternals(this).InputOptions());
}

bspc::EncodeOptions vtkBSPWriter::MakeEncodeOptions() {
  vtkInternals internals(this);
  bspc::EncodeOptions options;
  options.grid = internals.Grid();
  if (this->Method != nullptr && *this->Method != '\0') {
    options.method = bspc::methodFromName(this->Method);
    if (!options.method) {
      throw bspc::Error(bspc::ErrorCode::InvalidArgument,
                        "there is no method \"" + std::string(this->Method) + "\"");
    }
  }
  if (this->Effort > 0) options.effort = static_cast<unsigned>(this->Effort);
  options.keepOrder = this->KeepOrder;
  options.originalIds = this->StoreOriginalPointIds;
  options.layers = static_cast<unsigned>(this->NumberOfLevels);
  options.tilePoints = static_cast<std::uint64_t>(this->PointsPerTile);
  options.threads = static_cast<unsigned>(this->NumberOfThreads);
  options.layout = this->Layout == STREAMING ? bspc::Layout::Streaming : bspc::Layout::Progressive;
  options.metadata = bspc::vtk::metadataOf(this->GetInput()->GetFieldData());
  options.progress = [this](double share) {
    this->UpdateProgress(share);
    return !vtkInternals(this).Aborted();
  };
  return options;
}

void vtkBSPWriter::Report(const bspc::EncodeReport& report) {
  this->NumberOfPointsWritten = static_cast<vtkIdType>(report.points);
  this->NumberOfBytesWritten = static_cast<vtkIdType>(report.fileBytes);
  this->Exact = report.exact;
  std::copy(report.maxError.begin(), report.maxError.end(), this->MaximumError);
  this->MaximumArrayErrors.clear();
  for (const bspc::ArrayReport& array : report.arrays) {
    this->MaximumArrayErrors[array.name] = array.greatestError;
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
  return valueOf(this->ArrayTolerances, name);
}

double vtkBSPWriter::GetMaximumArrayError(const char* name) {
  return valueOf(this->MaximumArrayErrors, name);
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
  os << indent << "StoreOriginalPointIds: " << this->StoreOriginalPointIds << '\n';
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
