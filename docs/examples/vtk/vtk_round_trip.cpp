// Writes the points of a VTK pipeline to a .bspc file, and reads a part of it back.
#include <vtkBSPReader.h>
#include <vtkBSPWriter.h>
#include <vtkNew.h>
#include <vtkPointSource.h>
#include <vtkPolyData.h>

#include <cstdlib>
#include <iostream>

int main(int argc, char** argv) {
  if (argc != 2) {
    std::cerr << "Usage: vtk_round_trip FILE.bspc\n";
    return 2;
  }

  vtkNew<vtkPointSource> source;
  source->SetNumberOfPoints(100000);
  source->SetRadius(10);

  vtkNew<vtkBSPWriter> writer;
  writer->SetInputConnection(source->GetOutputPort());
  writer->SetFileName(argv[1]);
  writer->SetGridModeToPrecision();  // without this: as exact as the coordinates are
  writer->SetPrecision(0.001);
  if (writer->Write() == 0) return EXIT_FAILURE;  // VTK has printed the reason
  std::cout << writer->GetNumberOfPointsWritten() << " points in "
            << writer->GetNumberOfBytesWritten() << " bytes\n";

  vtkNew<vtkBSPReader> reader;
  reader->SetFileName(argv[1]);
  reader->UseBoxOn();
  reader->SetBox(0, 10, 0, 10, 0, 10);
  reader->Update();
  std::cout << reader->GetOutput()->GetNumberOfPoints() << " of "
            << reader->GetNumberOfPointsInFile() << " points are in the box\n";
  return reader->GetErrorCode() == 0 ? EXIT_SUCCESS : EXIT_FAILURE;
}
