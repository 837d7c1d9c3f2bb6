#include "vtkPVBSPWriter.h"

#include <algorithm>
#include <array>
#include <string>
#include <vector>
#include <vtksys/SystemTools.hxx>

#include "bspc/part_encoder.h"
#include "process_group.h"
#include "shared_file.h"
#include "vtkBSPWriter/input_points.h"
#include "vtkErrorCode.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkMultiProcessController.h"
#include "vtkObjectFactory.h"
#include "vtkStreamingDemandDrivenPipeline.h"

vtkStandardNewMacro(vtkPVBSPWriter);

vtkPVBSPWriter::vtkPVBSPWriter() : Controller(vtkMultiProcessController::GetGlobalController()) {}

vtkPVBSPWriter::~vtkPVBSPWriter() = default;

void vtkPVBSPWriter::SetController(vtkMultiProcessController* controller) {
  if (this->Controller == controller) return;
  this->Controller = controller;
  this->Modified();
}

vtkMultiProcessController* vtkPVBSPWriter::GetController() const { return this->Controller; }

int vtkPVBSPWriter::NumberOfProcesses() const {
  return this->Controller != nullptr ? this->Controller->GetNumberOfProcesses() : 1;
}

vtkTypeBool vtkPVBSPWriter::ProcessRequest(vtkInformation* request,
                                           vtkInformationVector** inputVector,
                                           vtkInformationVector* outputVector) {
  using Pipeline = vtkStreamingDemandDrivenPipeline;
  if (request->Has(Pipeline::REQUEST_UPDATE_EXTENT()) != 0 && this->NumberOfProcesses() > 1) {
    vtkInformation* input = inputVector[0]->GetInformationObject(0);
    input->Set(Pipeline::UPDATE_NUMBER_OF_PIECES(), this->NumberOfProcesses());
    input->Set(Pipeline::UPDATE_PIECE_NUMBER(), this->Controller->GetLocalProcessId());
    input->Set(Pipeline::UPDATE_NUMBER_OF_GHOST_LEVELS(), 0);
    return 1;
  }
  return this->Superclass::ProcessRequest(request, inputVector, outputVector);
}

void vtkPVBSPWriter::WriteData() {
  if (this->NumberOfProcesses() <= 1) {
    this->Superclass::WriteData();
  } else if (this->FilePerProcess) {
    this->WriteFileOfProcess();
  } else {
    this->Guard([this] { this->WriteTogether(); });
  }
}

void vtkPVBSPWriter::WriteFileOfProcess() {
  const std::string whole = this->GetFileName() != nullptr ? this->GetFileName() : "";
  const std::string extension = vtksys::SystemTools::GetFilenameLastExtension(whole);
  const std::string stem = whole.substr(0, whole.size() - extension.size());
  const int rank = this->Controller->GetLocalProcessId();
  this->SetFileName((stem + "." + std::to_string(rank) + extension).c_str());
  this->Superclass::WriteData();
  this->SetFileName(whole.c_str());
}

void vtkPVBSPWriter::WriteTogether() {
  bspc::vtk::ProcessGroup group(*this->Controller);
  std::unique_ptr<bspc::vtk::InputPoints> input;
  bspc::EncodeOptions options;
  bspc::Bytes description;
  group.step([&] {
    options = this->MakeEncodeOptions();
    input = this->ReadInput();
    description = bspc::describePart(input->view(), options);
  });
  const std::vector<bspc::Bytes> descriptions = group.gatherEverywhere(description);
  bspc::FilePart part;
  group.step(
      [&] { part = bspc::encodePart(input->view(), bspc::agreeOnParts(descriptions, options)); });
  input.reset();
  const std::vector<bspc::Bytes> summaries = group.gatherEverywhere(part.summary);
  bspc::FileFrame frame;
  group.step([&] { frame = bspc::frameParts(summaries); });
  bspc::vtk::SharedFile file(group, this->GetFileName(), frame.head);
  file.write(part.tiles, frame.offsets[group.rank()]);
  file.finish(frame.end, frame.endOffset);

  part.report.points = frame.points;
  part.report.fileBytes = frame.endOffset + frame.end.size();
  part.report.exact = group.all(part.report.exact);
  for (double& error : part.report.maxError) error = group.greatest(error);
  this->Report(part.report);
}

void vtkPVBSPWriter::PrintSelf(ostream& os, vtkIndent indent) {
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Controller: " << this->Controller.Get() << '\n';
  os << indent << "FilePerProcess: " << this->FilePerProcess << '\n';
}
