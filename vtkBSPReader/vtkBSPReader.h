/**
 * @class   vtkBSPReader
 * @brief   read compressed point sets (.bspc)
 *
 * vtkBSPReader reads the points of a .bspc file, with their arrays, into a vtkPolyData. Points are
 * in double precision where single precision would change them. Arrays that the file calls normals,
 * colours or scalars, and texture coordinates become the active ones of their kind. What a file
 * says beside its points is in the field data: its coordinate reference system as "CRS", its unit
 * as "LengthUnit", other text under its own key, and arrays.
 *
 * After UpdateInformation() the number of points, their bounds, the levels of detail and the names
 * of the arrays are known; no point has been decoded for them.
 *
 * The cells of a mesh, with their arrays, come with the whole set; parts of it (levels, boxes,
 * budgets) are points only.
 *
 * A file is read in pieces by tiles, such that pieces have about the same number of points; a file
 * of one tile, or with cells, is in one piece. On abort the output is empty.
 *
 * @sa vtkBSPWriter
 */

#ifndef vtkBSPReader_h
#define vtkBSPReader_h

#include <string>
#include <vector>

#include "vtkAbstractPolyDataReader.h"
#include "vtkBSPReaderModule.h"
#include "vtkSmartPointer.h"

class vtkDataArraySelection;

class VTKBSPREADER_EXPORT vtkBSPReader : public vtkAbstractPolyDataReader {
 public:
  static vtkBSPReader* New();
  vtkTypeMacro(vtkBSPReader, vtkAbstractPolyDataReader);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /// Whether the file begins as a .bspc file does.
  static int CanReadFile(VTK_FILEPATH const char* fileName);
  static const char* GetFileExtensions() { return ".bspc"; }
  static const char* GetDescriptiveName() { return "BSPC compressed points"; }

  ///@{
  /**
   * Read from bytes in memory instead of a file. Default: off.
   */
  vtkSetMacro(ReadFromInputString, bool);
  vtkGetMacro(ReadFromInputString, bool);
  vtkBooleanMacro(ReadFromInputString, bool);
  void SetInputString(const std::string& bytes);
  void SetInputString(const char* bytes, vtkIdType count);
  ///@}

  ///@{
  /**
   * The level of detail to read, 0 (coarsest) to GetNumberOfLevels() - 1, which is every point; so
   * is what is beyond. Points of a coarser level each stand for some. Default: -1, the finest.
   */
  vtkSetClampMacro(LevelOfDetail, int, -1, VTK_INT_MAX);
  vtkGetMacro(LevelOfDetail, int);
  ///@}

  ///@{
  /**
   * At most so many points (over all pieces): the finest level that fits, thinned where even the
   * coarsest does not. Default: 0, no limit.
   */
  vtkSetClampMacro(MaximumNumberOfPoints, vtkIdType, 0, VTK_ID_MAX);
  vtkGetMacro(MaximumNumberOfPoints, vtkIdType);
  ///@}

  ///@{
  /**
   * Only the points in the box (x min, x max, y min, y max, z min, z max; its faces belong to it),
   * and only from the tiles that touch it. Default: off.
   */
  vtkSetMacro(UseBox, bool);
  vtkGetMacro(UseBox, bool);
  vtkBooleanMacro(UseBox, bool);
  vtkSetVector6Macro(Box, double);
  vtkGetVector6Macro(Box, double);
  ///@}

  ///@{
  /**
   * Make one vertex cell a point, where there is no mesh; without cells nothing is rendered.
   * Default: on.
   */
  vtkSetMacro(GenerateVertices, bool);
  vtkGetMacro(GenerateVertices, bool);
  vtkBooleanMacro(GenerateVertices, bool);
  ///@}

  ///@{
  /**
   * Add a point array "CellId" with the cell of the coder's partition that each point lies in, at
   * the level CellIdLevel, or at the level that is read if that is coarser. Default: off, and -1:
   * the level that is read.
   */
  vtkSetMacro(GenerateCellIds, bool);
  vtkGetMacro(GenerateCellIds, bool);
  vtkBooleanMacro(GenerateCellIds, bool);
  vtkSetClampMacro(CellIdLevel, int, -1, VTK_INT_MAX);
  vtkGetMacro(CellIdLevel, int);
  ///@}

  ///@{
  /**
   * Add a point array "PointCount": how many points of the file each one stands for. Default: off.
   */
  vtkSetMacro(GeneratePointCounts, bool);
  vtkGetMacro(GeneratePointCounts, bool);
  vtkBooleanMacro(GeneratePointCounts, bool);
  ///@}

  ///@{
  /**
   * Take what is whole of a file that ends early instead of refusing it. Default: off.
   */
  vtkSetMacro(AllowPartial, bool);
  vtkGetMacro(AllowPartial, bool);
  vtkBooleanMacro(AllowPartial, bool);
  ///@}

  ///@{
  /**
   * Threads that decode. Default: 0, as many as the machine has. The output does not depend on it.
   */
  vtkSetClampMacro(NumberOfThreads, int, 0, VTK_INT_MAX);
  vtkGetMacro(NumberOfThreads, int);
  ///@}

  ///@{
  /**
   * The most memory that the output may take, in MiB, as a protection against files that unfold to
   * more than anybody wants. Decoding may take as much beside it, and at least 64 MiB. Default: 0,
   * the memory of the machine.
   */
  vtkSetClampMacro(MemoryLimit, vtkIdType, 0, VTK_ID_MAX >> 20);
  vtkGetMacro(MemoryLimit, vtkIdType);
  ///@}

  ///@{
  /**
   * The arrays of the file, and which of them to read; all by default. Those that are switched off
   * are not read from disk. Names are known after UpdateInformation().
   */
  int GetNumberOfPointArrays();
  const char* GetPointArrayName(int index);
  int GetPointArrayStatus(const char* name);
  void SetPointArrayStatus(const char* name, int status);
  virtual vtkDataArraySelection* GetPointDataArraySelection();
  ///@}

  ///@{
  /**
   * What the file says about itself, known after UpdateInformation(): points and tiles of the
   * whole file, bounds (x min, x max, …; an empty file has those of vtkMath::UninitializeBounds).
   * Bounds of coordinates that are kept bit for bit may be a little wider than the points are.
   */
  vtkGetMacro(NumberOfPointsInFile, vtkIdType);
  vtkGetMacro(NumberOfTiles, vtkIdType);
  vtkGetVector6Macro(BoundsOfFile, double);
  int GetNumberOfLevels();
  /// Points that reading up to that level gives; 0 if there is no such level.
  vtkIdType GetNumberOfPointsOfLevel(int level);
  ///@}

  /// Changes of the array selection count.
  vtkMTimeType GetMTime() override;

 protected:
  vtkBSPReader();
  ~vtkBSPReader() override;

  int RequestInformation(vtkInformation* request, vtkInformationVector** inputVector,
                         vtkInformationVector* outputVector) override;
  int RequestData(vtkInformation* request, vtkInformationVector** inputVector,
                  vtkInformationVector* outputVector) override;

 private:
  vtkBSPReader(const vtkBSPReader&) = delete;
  void operator=(const vtkBSPReader&) = delete;

  class vtkInternals;

  bool ReadFromInputString = false;
  std::string InputString;
  int LevelOfDetail = -1;
  vtkIdType MaximumNumberOfPoints = 0;
  bool UseBox = false;
  double Box[6] = {0, 1, 0, 1, 0, 1};
  bool GenerateVertices = true;
  bool GenerateCellIds = false;
  int CellIdLevel = -1;
  bool GeneratePointCounts = false;
  bool AllowPartial = false;
  int NumberOfThreads = 0;
  vtkIdType MemoryLimit = 0;
  vtkSmartPointer<vtkDataArraySelection> PointDataArraySelection;

  vtkIdType NumberOfPointsInFile = 0;
  vtkIdType NumberOfTiles = 0;
  double BoundsOfFile[6];
  std::vector<vtkIdType> PointsOfLevels;
};

#endif
