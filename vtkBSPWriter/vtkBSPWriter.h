/**
 * @class   vtkBSPWriter
 * @brief   write compressed point sets (.bspc)
 *
 * vtkBSPWriter writes the points of any vtkPointSet, or the rows of a vtkTable with columns x, y
 * and z, to a .bspc file, with their arrays and the field data. Points are kept exactly where they
 * lie on a lattice and to float precision otherwise, unless GridMode says something else; arrays
 * come back bit for bit unless they are given a tolerance. The order of points is not kept unless
 * KeepOrder is on; StoreOriginalPointIds adds an array that tells it. Active normals, scalars,
 * texture coordinates and ids are marked as such.
 *
 * The vertices, lines and polygons of vtkPolyData are written with their arrays, unless there are
 * vertices only, which the reader makes. Other cells are an error unless DropCells is on, and so
 * are ghosts of a mesh. Points that vtkGhostType marks as duplicates or hidden are left out, since
 * another piece of the data has them or nobody should see them.
 *
 * The file is written beside its place and renamed when it is whole. Write() returns 1 if that was
 * reached; on abort it returns 0, without an error code, and an older file stays as it was.
 *
 * @sa vtkBSPReader
 */

#ifndef vtkBSPWriter_h
#define vtkBSPWriter_h

#include <functional>
#include <map>
#include <memory>
#include <string>

#include "vtkBSPWriterModule.h"
#include "vtkSmartPointer.h"
#include "vtkWriter.h"

class vtkDataArraySelection;

namespace bspc {
struct EncodeOptions;
struct EncodeReport;
namespace vtk {
class InputPoints;
}
}  // namespace bspc

class VTKBSPWRITER_EXPORT vtkBSPWriter : public vtkWriter {
 public:
  static vtkBSPWriter* New();
  vtkTypeMacro(vtkBSPWriter, vtkWriter);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * The file to write.
   */
  vtkSetFilePathMacro(FileName);
  vtkGetFilePathMacro(FileName);
  ///@}

  static const char* GetFileExtensions() { return ".bspc"; }
  static const char* GetDescriptiveName() { return "BSPC compressed points"; }

  ///@{
  /**
   * Write to bytes in memory instead of a file. Default: off.
   */
  vtkSetMacro(WriteToOutputString, bool);
  vtkGetMacro(WriteToOutputString, bool);
  vtkBooleanMacro(WriteToOutputString, bool);
  const std::string& GetOutputString() const { return this->OutputString; }
  ///@}

  /// How coordinates become whole numbers.
  enum GridModes {
    /// Exactly if they lie on a lattice, which is searched for; otherwise to the spacing of the
    /// largest float coordinate, or to 31 bits of the extent for double coordinates.
    AUTOMATIC = 0,
    /// The largest extent spans 2^Bits - 1 steps.
    BITS = 1,
    /// Steps of Precision, in units of the data; errors are at most half of it.
    PRECISION = 2,
    /// Every coordinate bit for bit.
    EXACT = 3,
  };
  ///@{
  vtkSetClampMacro(GridMode, int, AUTOMATIC, EXACT);
  vtkGetMacro(GridMode, int);
  void SetGridModeToAutomatic() { this->SetGridMode(AUTOMATIC); }
  void SetGridModeToBits() { this->SetGridMode(BITS); }
  void SetGridModeToPrecision() { this->SetGridMode(PRECISION); }
  void SetGridModeToExact() { this->SetGridMode(EXACT); }
  ///@}

  ///@{
  /**
   * For GridMode BITS, 1 to 32. Default: 16.
   */
  vtkSetClampMacro(Bits, int, 1, 32);
  vtkGetMacro(Bits, int);
  ///@}

  ///@{
  /**
   * For GridMode PRECISION, above 0. Default: 0.001.
   */
  vtkSetMacro(Precision, double);
  vtkGetMacro(Precision, double);
  ///@}

  ///@{
  /**
   * How much time smallness is worth, from 1 (quickest). Default: 0, the library's choice.
   */
  vtkSetClampMacro(Effort, int, 0, 9);
  vtkGetMacro(Effort, int);
  ///@}

  ///@{
  /**
   * Name of the method that codes positions ("fast", "kd", "bsp", …). Default: none, the library's
   * choice.
   */
  vtkSetStringMacro(Method);
  vtkGetStringMacro(Method);
  ///@}

  ///@{
  /**
   * Keep the order of the points, which costs some bits a point. Default: off.
   */
  vtkSetMacro(KeepOrder, bool);
  vtkGetMacro(KeepOrder, bool);
  vtkBooleanMacro(KeepOrder, bool);
  ///@}

  ///@{
  /**
   * Add a point array "OriginalPointIds": which point of the input each one was, ghosts that are
   * left out not counted. A file of several processes cannot have it. Default: off.
   */
  vtkSetMacro(StoreOriginalPointIds, bool);
  vtkGetMacro(StoreOriginalPointIds, bool);
  vtkBooleanMacro(StoreOriginalPointIds, bool);
  ///@}

  /// Where the index stands: in front, so that every beginning of the file that ends on a layer can
  /// be read, or at the end.
  enum Layouts { PROGRESSIVE = 0, STREAMING = 1 };
  ///@{
  /**
   * Default: PROGRESSIVE.
   */
  vtkSetClampMacro(Layout, int, PROGRESSIVE, STREAMING);
  vtkGetMacro(Layout, int);
  void SetLayoutToProgressive() { this->SetLayout(PROGRESSIVE); }
  void SetLayoutToStreaming() { this->SetLayout(STREAMING); }
  ///@}

  ///@{
  /**
   * Levels of detail, 1 to 32. Default: 0, by the number of points.
   */
  vtkSetClampMacro(NumberOfLevels, int, 0, 32);
  vtkGetMacro(NumberOfLevels, int);
  ///@}

  ///@{
  /**
   * Most points of a tile, which is what parts of a file are read by. Default: 0, what suits the
   * method.
   */
  vtkSetClampMacro(PointsPerTile, vtkIdType, 0, VTK_ID_MAX);
  vtkGetMacro(PointsPerTile, vtkIdType);
  ///@}

  ///@{
  /**
   * Leave out all cells and their arrays. Default: off.
   */
  vtkSetMacro(DropCells, bool);
  vtkGetMacro(DropCells, bool);
  vtkBooleanMacro(DropCells, bool);
  ///@}

  ///@{
  /**
   * Leave out points with infinite coordinates or NaN instead of refusing them. Default: off.
   */
  vtkSetMacro(DropNonFinite, bool);
  vtkGetMacro(DropNonFinite, bool);
  vtkBooleanMacro(DropNonFinite, bool);
  ///@}

  ///@{
  /**
   * Threads that encode. Default: 0, as many as the machine has. The file does not depend on it.
   */
  vtkSetClampMacro(NumberOfThreads, int, 0, VTK_INT_MAX);
  vtkGetMacro(NumberOfThreads, int);
  ///@}

  ///@{
  /**
   * Which point arrays to write: those that are not switched off here.
   */
  virtual vtkDataArraySelection* GetPointDataArraySelection();
  int GetPointArrayStatus(const char* name);
  void SetPointArrayStatus(const char* name, int status);
  ///@}

  ///@{
  /**
   * Greatest error that values of an array may have (of normals: greatest angle, in degrees).
   * Default: 0, values come back bit for bit.
   */
  void SetArrayTolerance(const char* name, double tolerance);
  double GetArrayTolerance(const char* name);
  void ClearArrayTolerances();
  ///@}

  ///@{
  /**
   * What was written by the last Write(): points and bytes; whether every coordinate comes back as
   * the number that went in; if not, the greatest error along x, y and z.
   */
  vtkGetMacro(NumberOfPointsWritten, vtkIdType);
  vtkGetMacro(NumberOfBytesWritten, vtkIdType);
  vtkGetMacro(Exact, bool);
  vtkGetVector3Macro(MaximumError, double);
  /// The greatest error of a value of that array (of normals: the greatest angle, in degrees); 0 if
  /// all of them come back bit for bit.
  double GetMaximumArrayError(const char* name);
  ///@}

  /// Returns 1 if everything was written, else 0.
  int Write() override;

  /// Changes of the array selection count.
  vtkMTimeType GetMTime() override;

 protected:
  vtkBSPWriter();
  ~vtkBSPWriter() override;

  int FillInputPortInformation(int port, vtkInformation* info) override;
  void WriteData() override;

  ///@{
  /**
   * For writers that put a file together in another way. Guard() runs a body that writes the file;
   * what goes wrong becomes a VTK error. Within it, ReadInput() gives the points with the arrays
   * that are to be written, MakeEncodeOptions() says how, and Report() tells that all is written.
   */
  void Guard(const std::function<void()>& body);
  std::unique_ptr<bspc::vtk::InputPoints> ReadInput();
  bspc::EncodeOptions MakeEncodeOptions();
  void Report(const bspc::EncodeReport& report);
  ///@}

 private:
  vtkBSPWriter(const vtkBSPWriter&) = delete;
  void operator=(const vtkBSPWriter&) = delete;

  class vtkInternals;

  char* FileName = nullptr;
  bool WriteToOutputString = false;
  std::string OutputString;
  int GridMode = AUTOMATIC;
  int Bits = 16;
  double Precision = 0.001;
  int Effort = 0;
  char* Method = nullptr;
  bool KeepOrder = false;
  bool StoreOriginalPointIds = false;
  int Layout = PROGRESSIVE;
  int NumberOfLevels = 0;
  vtkIdType PointsPerTile = 0;
  bool DropCells = false;
  bool DropNonFinite = false;
  int NumberOfThreads = 0;
  vtkSmartPointer<vtkDataArraySelection> PointDataArraySelection;
  std::map<std::string, double> ArrayTolerances;

  bool Written = false;
  vtkIdType NumberOfPointsWritten = 0;
  vtkIdType NumberOfBytesWritten = 0;
  bool Exact = true;
  double MaximumError[3] = {0, 0, 0};
  std::map<std::string, double> MaximumArrayErrors;
};

#endif
