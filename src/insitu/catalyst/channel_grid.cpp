// SPDX-License-Identifier: BSD-3-Clause
#include "insitu/catalyst/channel_grid.hpp"

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkSmartPointer.h>
#include <vtkTypeInt32Array.h>
#include <vtkTypeInt64Array.h>

#include <algorithm>
#include <numeric>
#include <stdexcept>

namespace rhexis::insitu {
namespace {

/// The view's values [count, components], component by component in the view, tuple by tuple here.
vtkSmartPointer<vtkDataArray> copy(const FieldView& view) {
  auto array = vtkSmartPointer<vtkDoubleArray>::New();
  array->SetName(std::string(view.info.name).c_str());
  array->SetNumberOfComponents(view.info.components);
  array->SetNumberOfTuples(static_cast<vtkIdType>(view.count));
  double* values = array->GetPointer(0);
  const auto stride = static_cast<std::size_t>(view.info.components);
  for (std::size_t component = 0; component < stride; ++component) {
    const double* from = view.component[component];
    for (std::size_t i = 0; i < view.count; ++i) values[i * stride + component] = from[i];
  }
  return array;
}

/// Cells of `size` points each.
vtkSmartPointer<vtkCellArray> cells_of(vtkDataArray* points, vtkIdType size) {
  auto cells = vtkSmartPointer<vtkCellArray>::New();
  cells->SetData(size, points);
  return cells;
}

void add_value(vtkFieldData* data, std::string_view name, double value) {
  vtkNew<vtkDoubleArray> array;
  array->SetName(std::string(name).c_str());
  array->InsertNextValue(value);
  data->AddArray(array);
}

}  // namespace

vtkPolyData* ChannelGrid::fill(PointSource& source, const std::vector<std::string>& fields, long step,
                               double time_s) {
  vtkNew<vtkTypeInt32Array> points;
  points->SetNumberOfValues(static_cast<vtkIdType>(source.positions().count));
  std::iota(points->GetPointer(0), points->GetPointer(0) + points->GetNumberOfValues(), 0);
  grid_->SetVerts(cells_of(points, 1));
  fill_values(source, fields, step, time_s);
  return grid_;
}

vtkPolyData* ChannelGrid::fill(LineSource& source, const std::vector<std::string>& fields, long step,
                               double time_s) {
  const std::span<const std::int64_t> ends = source.connectivity();
  vtkNew<vtkTypeInt64Array> points;
  points->SetNumberOfValues(static_cast<vtkIdType>(ends.size()));
  std::copy(ends.begin(), ends.end(), points->GetPointer(0));
  grid_->SetLines(cells_of(points, 2));
  fill_values(source, fields, step, time_s);
  return grid_;
}

template <class Source>
void ChannelGrid::fill_values(Source& source, const std::vector<std::string>& fields, long step,
                              double time_s) {
  vtkNew<vtkPoints> points;
  points->SetData(copy(source.positions()));
  grid_->SetPoints(points);
  for (const std::string& name : fields) {
    const FieldView view = source.field(name);
    const bool of_points = view.info.centring == Centring::point;
    const vtkIdType owners = of_points ? grid_->GetNumberOfPoints() : grid_->GetNumberOfCells();
    if (static_cast<vtkIdType>(view.count) != owners)
      throw std::logic_error("field " + name + ": as many values as points or cells are due");
    vtkDataSetAttributes* data = grid_->GetPointData();
    if (!of_points) data = grid_->GetCellData();
    data->AddArray(copy(view));
  }
  add_value(grid_->GetFieldData(), "time", time_s);
  add_value(grid_->GetFieldData(), "step", static_cast<double>(step));
  for (const Annotation& note : source.annotations()) add_value(grid_->GetFieldData(), note.name, note.value);
}

void ChannelGrid::clear() {
  grid_->Initialize();
}

}  // namespace rhexis::insitu
