#include "vtkPVBSPReader.h"

#include <algorithm>

#include "vtkObjectFactory.h"

vtkStandardNewMacro(vtkPVBSPReader);

vtkPVBSPReader::vtkPVBSPReader() {
  this->ApplyLimit();
  this->ApplyBox();
}

void vtkPVBSPReader::ApplyLimit() {
  this->Superclass::SetMaximumNumberOfPoints(this->LimitPoints ? this->PointLimit : 0);
}

void vtkPVBSPReader::SetLimitPoints(bool limit) {
  this->LimitPoints = limit;
  this->ApplyLimit();
}

void vtkPVBSPReader::SetMaximumNumberOfPoints(vtkIdType points) {
  this->PointLimit = points;
  this->ApplyLimit();
}

int* vtkPVBSPReader::GetLevelRange() {
  this->LevelRange[1] = std::max(this->GetNumberOfLevels() - 1, 0);
  return this->LevelRange;
}

void vtkPVBSPReader::ApplyBox() {
  double box[6];
  for (int axis = 0; axis < 3; ++axis) {
    // The widget turns a box inside out when one of its faces is dragged past the other.
    const double end = this->BoxPosition[axis] + this->BoxSize[axis];
    box[2 * axis] = std::min(this->BoxPosition[axis], end);
    box[2 * axis + 1] = std::max(this->BoxPosition[axis], end);
  }
  this->SetBox(box);
}

void vtkPVBSPReader::SetBoxPosition(double x, double y, double z) {
  this->BoxPosition[0] = x;
  this->BoxPosition[1] = y;
  this->BoxPosition[2] = z;
  this->ApplyBox();
}

void vtkPVBSPReader::SetBoxSize(double x, double y, double z) {
  this->BoxSize[0] = x;
  this->BoxSize[1] = y;
  this->BoxSize[2] = z;
  this->ApplyBox();
}

double* vtkPVBSPReader::GetBoxSizeRange() {
  const double* bounds = this->GetBoundsOfFile();
  for (int axis = 0; axis < 3; ++axis) {
    this->BoxSizeRange[2 * axis + 1] = std::max(bounds[2 * axis + 1] - bounds[2 * axis], 0.0);
  }
  return this->BoxSizeRange;
}

void vtkPVBSPReader::PrintSelf(ostream& os, vtkIndent indent) {
  this->Superclass::PrintSelf(os, indent);
  os << indent << "LimitPoints: " << this->LimitPoints << '\n';
  os << indent << "PointLimit: " << this->PointLimit << '\n';
}
