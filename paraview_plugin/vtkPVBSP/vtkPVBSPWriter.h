/**
 * @class   vtkPVBSPWriter
 * @brief   vtkBSPWriter for several processes
 *
 * The processes of a controller write one file together: they agree on a grid, each codes its own
 * points and writes them to their place in the file. Nothing goes between them but what describes
 * the parts and the records of the index. All of them have to reach the file by its name.
 *
 * With FilePerProcess on, each writes a file of its own: NAME.0.bspc, NAME.1.bspc, ….
 *
 * Every process has to call Write(); it returns 1 on all or 0 on all of them. Cells are not written
 * by several processes; input with cells other than vertices needs DropCells.
 */

#ifndef vtkPVBSPWriter_h
#define vtkPVBSPWriter_h

#include "vtkBSPWriter.h"
#include "vtkPVBSPModule.h"
#include "vtkSmartPointer.h"

class vtkMultiProcessController;

class VTKPVBSP_EXPORT vtkPVBSPWriter : public vtkBSPWriter {
 public:
  static vtkPVBSPWriter* New();
  vtkTypeMacro(vtkPVBSPWriter, vtkBSPWriter);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /// The processes that write together; at first the global controller.
  void SetController(vtkMultiProcessController* controller);
  vtkMultiProcessController* GetController() const;
  ///@}

  ///@{
  /// Write a file for each process instead of one for all. Default: off.
  vtkSetMacro(FilePerProcess, bool);
  vtkGetMacro(FilePerProcess, bool);
  vtkBooleanMacro(FilePerProcess, bool);
  ///@}

  /// Asks upstream for the piece of this process.
  vtkTypeBool ProcessRequest(vtkInformation* request, vtkInformationVector** inputVector,
                             vtkInformationVector* outputVector) override;

 protected:
  vtkPVBSPWriter();
  ~vtkPVBSPWriter() override;

  void WriteData() override;

 private:
  vtkPVBSPWriter(const vtkPVBSPWriter&) = delete;
  void operator=(const vtkPVBSPWriter&) = delete;

  int NumberOfProcesses() const;
  void WriteTogether();
  void WriteFileOfProcess();

  vtkSmartPointer<vtkMultiProcessController> Controller;
  bool FilePerProcess = false;
};

#endif
