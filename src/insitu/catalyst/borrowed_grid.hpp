/// A source as VTK sees it: particles as points, each a vertex cell; a network as points and lines; with the
/// fields asked for as point or cell data, as their centring says.
#pragma once

#include <vtkNew.h>
#include <vtkPolyData.h>
#include <vtkTypeInt64Array.h>

#include <string>
#include <vector>

#include "core/field_view.hpp"

namespace rhexis::insitu {

class BorrowedGrid {
 public:
  /// Lends the source's memory to VTK (no copy); only the fields named are asked of the source. Annotations,
  /// time and step become field data of one value each: `time` (s), `step` and the annotations' own names (SI
  /// units).
  vtkPolyData* lend(PointSource& source, const std::vector<std::string>& fields);
  vtkPolyData* lend(LineSource& source, const std::vector<std::string>& fields);

  /// Takes the memory back; what was made here for all times (vertex cells, offsets of lines) stays.
  void release();

 private:
  template <class Source>
  void lend_values(Source& source, const std::vector<std::string>& fields);
  void make_vertices(vtkIdType count);
  void make_offsets(vtkIdType lines);

  vtkNew<vtkPolyData> grid_;
  vtkNew<vtkCellArray> vertices_;
  vtkNew<vtkTypeInt64Array> offsets_;  ///< where each line starts in the connectivity: 0, 2, 4 ...
};

}  // namespace rhexis::insitu
