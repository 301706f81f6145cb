/// A PointSource as VTK sees it: points, each a vertex cell, with the fields asked for as point data.
#pragma once

#include <vtkNew.h>
#include <vtkPolyData.h>

#include <string>
#include <vector>

#include "core/field_view.hpp"

namespace rhexis::insitu {

class ParticleGrid {
 public:
  /// Lends the source's memory to VTK (no copy); only the fields named are asked of the source. Annotations,
  /// time and step become field data of one value each: `time` (s), `step` and the annotations' own names (SI
  /// units).
  vtkPolyData* lend(PointSource& source, const std::vector<std::string>& fields);

  /// Takes the memory back; the vertex cells, which never change, stay.
  void release();

 private:
  void make_vertices(vtkIdType count);

  vtkNew<vtkPolyData> grid_;
  vtkNew<vtkCellArray> vertices_;
};

}  // namespace rhexis::insitu
