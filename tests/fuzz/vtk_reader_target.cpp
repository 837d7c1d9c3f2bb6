// Any bytes as the input string of vtkBSPReader.

#include <vtkCellArray.h>
#include <vtkNew.h>
#include <vtkObject.h>
#include <vtkPolyData.h>

#include "target.h"
#include "vtkBSPReader.h"

namespace bspc::fuzz {

namespace {

void runVtkReader(ByteView input) {
  vtkObject::GlobalWarningDisplayOff();
  vtkNew<vtkBSPReader> reader;
  reader->SetNumberOfThreads(1);
  reader->ReadFromInputStringOn();
  reader->SetInputString(reinterpret_cast<const char*>(input.data()),
                         static_cast<vtkIdType>(input.size()));
  reader->SetMemoryLimit(1);
  // Sizes of files are as good as random.
  if (input.size() % 2 == 0) reader->SetMaximumNumberOfPoints(500);
  reader->SetAllowPartial(input.size() % 3 == 0);
  reader->SetGenerateCellIds(input.size() % 5 == 0);
  reader->SetGeneratePointCounts(input.size() % 7 == 0);
  reader->SetLevelOfDetail(static_cast<int>(input.size() % 4) - 1);
  reader->Update();
  vtkPolyData* const output = reader->GetOutput();
  const vtkIdType points = output->GetNumberOfPoints();
  for (vtkCellArray* cells : {output->GetVerts(), output->GetLines(), output->GetPolys()}) {
    for (vtkIdType c = 0; c < cells->GetNumberOfCells(); ++c) {
      vtkIdType count = 0;
      const vtkIdType* corners = nullptr;
      cells->GetCellAtId(c, count, corners);
      for (vtkIdType i = 0; i < count; ++i) {
        if (corners[i] < 0 || corners[i] >= points) fail("a cell of a point that there is not");
      }
    }
  }
}

}  // namespace

Target vtkReaderTarget() { return fileTarget("vtk_reader", runVtkReader); }

}  // namespace bspc::fuzz
