// SPDX-License-Identifier: BSD-3-Clause
/// A source as VTK sees it: particles as points, each a vertex cell; a network as points and lines; with the
/// fields asked for as point or cell data, as their centring says. The values are copies, one for each
/// script: whatever a script does to them, neither the solver nor another script sees it.
#pragma once

#include <vtkNew.h>
#include <vtkPolyData.h>

#include <string>
#include <vector>

#include "core/field_view.hpp"

namespace rhexis::insitu {

class ChannelGrid {
 public:
  /// Copies the source's positions and the fields named; no others are asked of it. Annotations, time and
  /// step become field data of one value each: `time` (s), `step` and the annotations' own names (SI units).
  vtkPolyData* fill(PointSource& source, const std::vector<std::string>& fields, long step, double time_s);
  vtkPolyData* fill(LineSource& source, const std::vector<std::string>& fields, long step, double time_s);

  /// Lets go of the values.
  void clear();

 private:
  template <class Source>
  void fill_values(Source& source, const std::vector<std::string>& fields, long step, double time_s);

  vtkNew<vtkPolyData> grid_;
};

}  // namespace rhexis::insitu
