#include "insitu/catalyst/borrowed_grid.hpp"

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkSOADataArrayTemplate.h>
#include <vtkSmartPointer.h>
#include <vtkTypeInt32Array.h>

#include <numeric>
#include <stdexcept>

namespace rhexis::insitu {
namespace {

vtkSmartPointer<vtkDataArray> borrow(const FieldView& view) {
  auto array = vtkSmartPointer<vtkSOADataArrayTemplate<double>>::New();
  array->SetName(std::string(view.info.name).c_str());
  array->SetNumberOfComponents(view.info.components);
  for (int component = 0; component < view.info.components; ++component) {
    // VTK's interface has no const, but filters leave their input alone; `save`: VTK must not free it.
    auto* values = const_cast<double*>(view.component[static_cast<std::size_t>(component)]);
    array->SetArray(component, values, static_cast<vtkIdType>(view.count), /*updateMaxId=*/true,
                    /*save=*/true);
  }
  return array;
}

void add_value(vtkFieldData* data, std::string_view name, double value) {
  vtkNew<vtkDoubleArray> array;
  array->SetName(std::string(name).c_str());
  array->InsertNextValue(value);
  data->AddArray(array);
}

}  // namespace

vtkPolyData* BorrowedGrid::lend(PointSource& source, const std::vector<std::string>& fields) {
  make_vertices(static_cast<vtkIdType>(source.positions().count));
  grid_->SetVerts(vertices_);
  lend_values(source, fields);
  return grid_;
}

vtkPolyData* BorrowedGrid::lend(LineSource& source, const std::vector<std::string>& fields) {
  const std::span<const std::int64_t> ends = source.connectivity();
  make_offsets(static_cast<vtkIdType>(ends.size() / 2));
  vtkNew<vtkTypeInt64Array> connectivity;
  // VTK's 64-bit integer is long long, the standard's may be long.
  auto* borrowed_ends = reinterpret_cast<vtkTypeInt64*>(const_cast<std::int64_t*>(ends.data()));
  connectivity->SetArray(borrowed_ends, static_cast<vtkIdType>(ends.size()), /*save=*/1);
  vtkNew<vtkCellArray> lines;
  lines->SetData(offsets_, connectivity);
  grid_->SetLines(lines);
  lend_values(source, fields);
  return grid_;
}

template <class Source>
void BorrowedGrid::lend_values(Source& source, const std::vector<std::string>& fields) {
  vtkNew<vtkPoints> points;
  points->SetData(borrow(source.positions()));
  grid_->SetPoints(points);
  for (const std::string& name : fields) {
    const FieldView view = source.field(name);
    const bool of_points = view.info.centring == Centring::point;
    const vtkIdType owners = of_points ? grid_->GetNumberOfPoints() : grid_->GetNumberOfCells();
    if (static_cast<vtkIdType>(view.count) != owners)
      throw std::logic_error("field " + name + ": as many values as points or cells are due");
    vtkDataSetAttributes* data = grid_->GetPointData();
    if (!of_points) data = grid_->GetCellData();
    data->AddArray(borrow(view));
  }
  add_value(grid_->GetFieldData(), "time", source.time_s());
  add_value(grid_->GetFieldData(), "step", static_cast<double>(source.step()));
  for (const Annotation& note : source.annotations()) add_value(grid_->GetFieldData(), note.name, note.value);
}

void BorrowedGrid::release() {
  grid_->Initialize();
}

void BorrowedGrid::make_vertices(vtkIdType count) {
  if (vertices_->GetNumberOfCells() == count) return;
  vtkNew<vtkTypeInt32Array> offsets;
  vtkNew<vtkTypeInt32Array> points;
  offsets->SetNumberOfValues(count + 1);
  points->SetNumberOfValues(count);
  std::iota(offsets->GetPointer(0), offsets->GetPointer(0) + count + 1, 0);
  std::iota(points->GetPointer(0), points->GetPointer(0) + count, 0);
  vertices_->SetData(offsets, points);
}

void BorrowedGrid::make_offsets(vtkIdType lines) {
  if (offsets_->GetNumberOfValues() == lines + 1) return;
  offsets_->SetNumberOfValues(lines + 1);
  for (vtkIdType line = 0; line <= lines; ++line) offsets_->SetValue(line, 2 * line);
}

}  // namespace rhexis::insitu
