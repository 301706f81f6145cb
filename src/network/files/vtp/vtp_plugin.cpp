// SPDX-License-Identifier: BSD-3-Clause
// The plugin librhexis_vtp.so: VTP files by VTK's own reader and writer.
#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkDoubleArray.h>
#include <vtkIntArray.h>
#include <vtkLogger.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkOutputWindow.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkPolyDataReader.h>
#include <vtkSmartPointer.h>
#include <vtkXMLDataElement.h>
#include <vtkXMLDataParser.h>
#include <vtkXMLPolyDataReader.h>
#include <vtkXMLPolyDataWriter.h>

#include <cstdint>
#include <exception>
#include <filesystem>
#include <new>
#include <set>
#include <string>

#include "network/files/vtp/child_process.hpp"
#include "network/files/vtp/interface.hpp"

extern "C" {
/// A function of expat since 2.6, and of older ones with their security patches; null in those without.
[[gnu::weak]] unsigned char XML_SetReparseDeferralEnabled(void* parser, unsigned char enabled);
}

namespace rhexis::network::vtp {
namespace {

/// VTK's parser, told to report the tag of appended data as soon as it has read it: newer versions of expat
/// may wait for more text, and VTK 9.1 then takes the data for text.
class PromptParser : public vtkXMLDataParser {
 public:
  vtkTypeMacro(PromptParser, vtkXMLDataParser) static PromptParser* New() {
    VTK_STANDARD_NEW_BODY(PromptParser);
  }

 protected:
  int CreateParser() override {
    const int done = vtkXMLDataParser::CreateParser();
    if (done != 0 && XML_SetReparseDeferralEnabled != nullptr) XML_SetReparseDeferralEnabled(Parser, 0);
    return done;
  }
};

class XmlReader : public vtkXMLPolyDataReader {
 public:
  vtkTypeMacro(XmlReader, vtkXMLPolyDataReader) static XmlReader* New() { VTK_STANDARD_NEW_BODY(XmlReader); }

 protected:
  void CreateXMLParser() override { XMLParser = PromptParser::New(); }

  int ReadPrimaryElement(vtkXMLDataElement* data) override {
    std::string fault = fault_of_counts(data);
    if (fault.empty()) fault = fault_of(data);
    if (!fault.empty()) {
      vtkErrorMacro(<< fault);
      return 0;
    }
    return vtkXMLPolyDataReader::ReadPrimaryElement(data);
  }

 private:
  /// A number of points or cells that is none, or that a file of this size cannot hold; empty: there is none.
  std::string fault_of_counts(vtkXMLDataElement* data) {
    constexpr std::uintmax_t most_compressed = 1024;  // of zlib, which VTK compresses with
    const std::uintmax_t bytes = std::filesystem::file_size(GetFileName());
    for (int i = 0; i < data->GetNumberOfNestedElements(); ++i) {
      vtkXMLDataElement* piece = data->GetNestedElement(i);
      for (const char* name :
           {"NumberOfPoints", "NumberOfVerts", "NumberOfLines", "NumberOfStrips", "NumberOfPolys"}) {
        const char* given = piece->GetAttribute(name);
        if (given == nullptr || *given == '\0') continue;  // 0 to VTK
        const std::string told = std::string(name) + " = " + std::string(given).substr(0, 40);
        vtkIdType count = 0;
        if (piece->GetScalarAttribute(name, count) == 0 || count < 0)
          return told + " is no number of points or cells";
        if (static_cast<std::uintmax_t>(count) > most_compressed * bytes)
          return told + ", which a file of " + std::to_string(bytes) + " bytes cannot hold";
      }
    }
    return {};
  }

  /// Faults in a list of arrays, or in those below it, that VTK does not see and that take it out of its
  /// memory or into a loop; empty: there are none.
  static std::string fault_of(vtkXMLDataElement* list) {
    constexpr vtkIdType most_components = 1 << 20;
    std::set<std::string> names;
    for (int i = 0; i < list->GetNumberOfNestedElements(); ++i) {
      vtkXMLDataElement* element = list->GetNestedElement(i);
      const char* given = element->GetAttribute("Name");
      const std::string name = given == nullptr ? "" : given;
      if (given != nullptr && !names.insert(name).second)
        return "two arrays of the points, or of the cells, have the name " + name;
      vtkIdType components = 1;
      if (element->GetScalarAttribute("NumberOfComponents", components) != 0 &&
          (components < 1 || components > most_components))
        return "array " + name + " has " + std::to_string(components) + " components";
      if (std::string fault = fault_of(element); !fault.empty()) return fault;
    }
    return {};
  }
};

/// Takes what VTK would print: errors are kept, the rest is dropped.
class SilentWindow : public vtkOutputWindow {
 public:
  vtkTypeMacro(SilentWindow, vtkOutputWindow) static SilentWindow* New() {
    VTK_STANDARD_NEW_BODY(SilentWindow);
  }
  void DisplayText(const char*) override {}
  void DisplayErrorText(const char* text) override {
    if (errors.empty()) errors = last_sentence(text == nullptr ? "unknown error" : text);
  }
  void DisplayWarningText(const char*) override {}
  void DisplayGenericWarningText(const char*) override {}
  void DisplayDebugText(const char*) override {}

  std::string errors;

 private:
  /// VTK begins with source file, line, class and address, up to "): "; the message follows.
  static std::string last_sentence(std::string text) {
    const auto begin = text.find("): ");
    if (begin != std::string::npos) text.erase(0, begin + 3);
    while (!text.empty() && (text.back() == '\n' || text.back() == ' ')) text.pop_back();
    for (char& c : text) {
      if (c == '\n') c = ' ';
    }
    return text;
  }
};

/// VTK's messages go to `window` as long as this lives.
class Silence {
 public:
  Silence() : before_(vtkOutputWindow::GetInstance()), verbosity_(vtkLogger::GetCurrentVerbosityCutoff()) {
    vtkOutputWindow::SetInstance(window);
    vtkLogger::SetStderrVerbosity(vtkLogger::VERBOSITY_OFF);
  }
  ~Silence() {
    vtkLogger::SetStderrVerbosity(verbosity_);
    vtkOutputWindow::SetInstance(before_);
  }
  Silence(const Silence&) = delete;
  Silence& operator=(const Silence&) = delete;

  vtkNew<SilentWindow> window;

 private:
  vtkSmartPointer<vtkOutputWindow> before_;
  vtkLogger::Verbosity verbosity_;
};

std::vector<Array> arrays_of(vtkDataSetAttributes* attributes, vtkIdType first, vtkIdType count) {
  std::vector<Array> arrays;
  for (int a = 0; a < attributes->GetNumberOfArrays(); ++a) {
    vtkDataArray* from = attributes->GetArray(a);  // null for text
    if (from == nullptr || from->GetName() == nullptr) continue;
    if (from->GetNumberOfTuples() < first + count) continue;
    Array array{from->GetName(), from->GetNumberOfComponents(), false, {}};
    array.values.reserve(static_cast<std::size_t>(count * array.components));
    for (vtkIdType i = first; i < first + count; ++i) {
      for (int c = 0; c < array.components; ++c) array.values.push_back(from->GetComponent(i, c));
    }
    arrays.push_back(std::move(array));
  }
  return arrays;
}

void copy_lines(vtkPolyData* data, Lines& lines) {
  const vtkIdType points = data->GetNumberOfPoints();
  lines.coordinates.resize(static_cast<std::size_t>(3 * points));
  for (vtkIdType p = 0; p < points; ++p)
    data->GetPoint(p, &lines.coordinates[3 * static_cast<std::size_t>(p)]);
  lines.first_cell = data->GetNumberOfVerts();
  vtkCellArray* cells = data->GetLines();
  for (vtkIdType l = 0; l < cells->GetNumberOfCells(); ++l) {
    vtkIdType size = 0;
    const vtkIdType* ids = nullptr;
    cells->GetCellAtId(l, size, ids);
    lines.connectivity.insert(lines.connectivity.end(), ids, ids + size);
    lines.offsets.push_back(static_cast<std::int64_t>(lines.connectivity.size()));
  }
  lines.point_arrays = arrays_of(data->GetPointData(), 0, points);
  lines.cell_arrays = arrays_of(data->GetCellData(), lines.first_cell, cells->GetNumberOfCells());
}

/// Offsets that go astray would take VTK's own loops out of its memory.
std::string check_offsets(vtkPolyData* data) {
  vtkCellArray* cells = data->GetLines();
  vtkDataArray* offsets = cells->GetOffsetsArray();
  const auto end = static_cast<double>(cells->GetNumberOfConnectivityIds());
  double before = 0;
  for (vtkIdType i = 0; i < offsets->GetNumberOfTuples(); ++i) {
    const double offset = offsets->GetComponent(i, 0);
    if (offset < before || offset > end) return "the offsets of its lines do not fit their connectivity";
    before = offset;
  }
  return {};
}

void add_arrays(vtkDataSetAttributes* attributes, const std::vector<Array>& arrays) {
  for (const Array& array : arrays) {
    vtkSmartPointer<vtkDataArray> to;
    if (array.integer) {
      to = vtkSmartPointer<vtkIntArray>::New();
    } else {
      to = vtkSmartPointer<vtkDoubleArray>::New();
    }
    to->SetName(array.name.c_str());
    to->SetNumberOfComponents(array.components);
    to->SetNumberOfTuples(static_cast<vtkIdType>(array.values.size()) / array.components);
    for (std::size_t i = 0; i < array.values.size(); ++i) {
      to->SetComponent(static_cast<vtkIdType>(i) / array.components, static_cast<int>(i) % array.components,
                       array.values[i]);
    }
    attributes->AddArray(to);
  }
}

vtkSmartPointer<vtkPolyData> poly_data_of(const Lines& lines) {
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  points->SetNumberOfPoints(static_cast<vtkIdType>(lines.points()));
  for (std::size_t p = 0; p < lines.points(); ++p) {
    points->SetPoint(static_cast<vtkIdType>(p), &lines.coordinates[3 * p]);
  }
  vtkNew<vtkCellArray> cells;
  for (std::size_t l = 0; l < lines.lines(); ++l) {
    cells->InsertNextCell(static_cast<int>(lines.offsets[l + 1] - lines.offsets[l]));
    for (auto i = lines.offsets[l]; i < lines.offsets[l + 1]; ++i) {
      cells->InsertCellPoint(lines.connectivity[static_cast<std::size_t>(i)]);
    }
  }
  auto data = vtkSmartPointer<vtkPolyData>::New();
  data->SetPoints(points);
  data->SetLines(cells);
  add_arrays(data->GetPointData(), lines.point_arrays);
  add_arrays(data->GetCellData(), lines.cell_arrays);
  return data;
}

/// What VTK says went wrong; empty if nothing.
std::string complaint(const Silence& silence, bool done, unsigned long code) {
  if (!silence.window->errors.empty()) return silence.window->errors;
  return done && code == 0 ? std::string() : "VTK's error code " + std::to_string(code);
}

/// Reads what a reader of VTK's is set up for.
template <class Reader>
void read_here(Reader* reader, Lines& lines, std::string& problem) try {
  const Silence silence;
  reader->Update();
  problem = complaint(silence, true, reader->GetErrorCode());
  vtkPolyData* data = reader->GetOutput();
  if (problem.empty()) problem = data == nullptr ? "no PolyData" : check_offsets(data);
  if (problem.empty()) copy_lines(data, lines);
} catch (const std::bad_alloc&) {  // what a newer VTK throws where an older one crashes
  problem = "VTK finds no memory for it: the numbers in the file's tags do not fit its data";
} catch (const std::exception& error) {
  problem = error.what();
}

void read_xml(const std::string& path, Lines& lines, std::string& problem) {
  vtkNew<XmlReader> reader;
  reader->SetFileName(path.c_str());
  read_here(reader.Get(), lines, problem);
}

void read_legacy(const std::string& path, Lines& lines, std::string& problem) {
  vtkNew<vtkPolyDataReader> reader;
  reader->SetFileName(path.c_str());
  // VTK reads the first array of a kind only, unless it is told otherwise.
  reader->ReadAllScalarsOn();
  reader->ReadAllVectorsOn();
  reader->ReadAllFieldsOn();
  read_here(reader.Get(), lines, problem);
}

}  // namespace

extern "C" void rhexis_vtp_read(const std::string& path, Format format, Lines& lines,
                                std::string& problem) try {
  std::error_code failure;
  const std::uintmax_t bytes = std::filesystem::file_size(path, failure);
  problem = failure ? failure.message() : std::string();
  if (failure) return;
  const auto read = format == Format::legacy ? read_legacy : read_xml;
  read_in_child([&](Lines& l, std::string& p) { read(path, l, p); }, bytes, lines, problem);
} catch (const std::exception& error) {
  problem = error.what();
}

extern "C" void rhexis_vtp_write(const std::string& path, const Lines& lines, std::string& problem) try {
  const Silence silence;
  vtkNew<vtkXMLPolyDataWriter> writer;
  writer->SetFileName(path.c_str());
  writer->SetInputData(poly_data_of(lines));
  // In place: VTK's reader of appended data fails with newer versions of expat.
  writer->SetDataModeToBinary();
  writer->SetHeaderTypeToUInt64();
  const bool written = writer->Write() != 0;
  problem = complaint(silence, written, writer->GetErrorCode());
} catch (const std::exception& error) {
  problem = error.what();
}

}  // namespace rhexis::network::vtp
