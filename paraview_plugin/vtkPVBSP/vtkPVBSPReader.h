/**
 * @class   vtkPVBSPReader
 * @brief   vtkBSPReader with what ParaView's panels set and ask for
 *
 * A level of detail has a range for a slider, a box is a position and a size as the box widget has
 * them, and the limit on the number of points can be switched off without being forgotten.
 */

#ifndef vtkPVBSPReader_h
#define vtkPVBSPReader_h

#include "vtkBSPReader.h"
#include "vtkPVBSPModule.h"

class VTKPVBSP_EXPORT vtkPVBSPReader : public vtkBSPReader {
 public:
  static vtkPVBSPReader* New();
  vtkTypeMacro(vtkPVBSPReader, vtkBSPReader);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /// Whether the limit on the number of points counts. Default: on.
  void SetLimitPoints(bool limit);
  vtkGetMacro(LimitPoints, bool);
  ///@}
  /// The limit; see LimitPoints.
  void SetMaximumNumberOfPoints(vtkIdType points) override;

  /// The coarsest and the finest level of the file.
  int* GetLevelRange() VTK_SIZEHINT(2);

  ///@{
  /// The box as its corner of smallest coordinates and its lengths.
  void SetBoxPosition(double x, double y, double z);
  void SetBoxSize(double x, double y, double z);
  ///@}
  /// For each axis 0 and the length of the bounds of the file.
  double* GetBoxSizeRange() VTK_SIZEHINT(6);

 protected:
  vtkPVBSPReader();
  ~vtkPVBSPReader() override = default;

 private:
  vtkPVBSPReader(const vtkPVBSPReader&) = delete;
  void operator=(const vtkPVBSPReader&) = delete;

  void ApplyLimit();
  void ApplyBox();

  bool LimitPoints = true;
  vtkIdType PointLimit = 2000000;
  int LevelRange[2] = {0, 0};
  double BoxPosition[3] = {0, 0, 0};
  double BoxSize[3] = {1, 1, 1};
  double BoxSizeRange[6] = {0, 0, 0, 0, 0, 0};
};

#endif
