#include "insitu/catalyst/particle_grid.hpp"

#include <vtkCellArray.h>
#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkSOADataArrayTemplate.h>
#include <vtkSmartPointer.h>
#include <vtkTypeInt32Array.h>

#include <numeric>

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

vtkPolyData* ParticleGrid::lend(PointSource& source, const std::vector<std::string>& fields) {
  const FieldView positions = source.positions();
  make_vertices(static_cast<vtkIdType>(positions.count));
  vtkNew<vtkPoints> points;
  points->SetData(borrow(positions));
  grid_->SetPoints(points);
  grid_->SetVerts(vertices_);
  for (const std::string& name : fields) grid_->GetPointData()->AddArray(borrow(source.field(name)));
  add_value(grid_->GetFieldData(), "time", source.time_s());
  add_value(grid_->GetFieldData(), "step", static_cast<double>(source.step()));
  for (const Annotation& note : source.annotations()) add_value(grid_->GetFieldData(), note.name, note.value);
  return grid_;
}

void ParticleGrid::release() {
  grid_->Initialize();
}

void ParticleGrid::make_vertices(vtkIdType count) {
  if (vertices_->GetNumberOfCells() == count) return;
  vtkNew<vtkTypeInt32Array> offsets;
  vtkNew<vtkTypeInt32Array> points;
  offsets->SetNumberOfValues(count + 1);
  points->SetNumberOfValues(count);
  std::iota(offsets->GetPointer(0), offsets->GetPointer(0) + count + 1, 0);
  std::iota(points->GetPointer(0), points->GetPointer(0) + count, 0);
  vertices_->SetData(offsets, points);
}

}  // namespace rhexis::insitu
