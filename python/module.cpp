// The Python module goniochrome._core: paints, fits, color differences and environments as arrays of numpy. The library
// knows nothing of Python, and all that does stands here. python/package/__init__.pyi states types and shapes.
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <array>
#include <cmath>

#include "base/angles.h"
#include "base/file.h"
#include "brdf/lobe_model.h"
#include "color/color.h"
#include "envmap/environment.h"
#include "envmap/prefiltered.h"
#include "fit/paint_fit.h"
#include "formats/basis.h"
#include "formats/paint_source.h"
#include "formats/xml.h"
#include "paint/curve.h"
#include "paint/metrics.h"

namespace py = pybind11;

namespace goniochrome::python {

namespace {

using Array = py::array_t<double, py::array::c_style | py::array::forcecast>;

// An error of the library as it is raised in Python.
class Failure : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

template <class T>
T value_of(Result<T> result) {
  if (!result.ok()) throw Failure(result.error().message);
  return std::move(result).value();
}
void check(const Result<void>& result) {
  if (!result.ok()) throw Failure(result.error().message);
}

// A view of numbers that `owner` keeps: nothing is copied, and the owner lives as long as the array.
template <class Number>
py::array view_of(const Number* data, std::vector<py::ssize_t> shape, const py::handle& owner) {
  py::array_t<Number> array(std::move(shape), data, owner);
  array.attr("flags").attr("writeable") = false;
  return array;
}

Array array_of(const std::vector<std::array<double, 3>>& rows) {
  Array array({static_cast<py::ssize_t>(rows.size()), py::ssize_t{3}});
  std::copy_n(rows.empty() ? nullptr : rows.front().data(), 3 * rows.size(), array.mutable_data());
  return array;
}
std::array<double, 3> triple(const color::Lab& lab) {
  return {lab.L, lab.a, lab.b};
}
std::array<double, 3> triple(const Vec3& v) {
  return {v.x, v.y, v.z};
}

// The number of triples of an array whose last axis has three numbers.
std::size_t triples(const Array& array, const char* what) {
  if (array.ndim() < 1 || array.shape(array.ndim() - 1) != 3)
    throw Failure(std::string(what) + ": the last axis has to have three numbers");
  return static_cast<std::size_t>(array.size() / 3);
}
std::vector<py::ssize_t> shape_of(const Array& array, std::size_t leave_out) {
  return {array.shape(), array.shape() + array.ndim() - static_cast<py::ssize_t>(leave_out)};
}

// `one` of each triple, which makes a triple.
template <class One>
Array each(const Array& array, const char* what, const One& one) {
  const std::size_t count = triples(array, what);
  Array result(shape_of(array, 0));
  const double* in = array.data();
  double* out = result.mutable_data();
  for (std::size_t i = 0; i < count; ++i, in += 3, out += 3) {
    const std::array<double, 3> made = one(in);
    std::copy(made.begin(), made.end(), out);
  }
  return result;
}

Array difference(const Array& x, const Array& y, double (*of)(const color::Lab&, const color::Lab&)) {
  const std::size_t count = triples(x, "x"), other = triples(y, "y");
  if (count != other && other != 1) throw Failure("y has to have as many colors as x, or one");
  Array result(shape_of(x, 1));
  const double *a = x.data(), *b = y.data();
  double* out = result.mutable_data();
  for (std::size_t i = 0; i < count; ++i, a += 3, b += other == 1 ? 0 : 3)
    out[i] = of({a[0], a[1], a[2]}, {b[0], b[1], b[2]});
  return result;
}

color::Xyz white_of(const std::string& illuminant, int observer_deg) {
  return value_of(color::white_point({illuminant, observer_deg}));
}

const paint::LobeFit& lobes_of(const paint::Paint& paint) {
  if (!paint.lobes) throw Failure("paint \"" + paint.name + "\" has no lobes: fit it first");
  return *paint.lobes;
}

// f of every pair of directions, in the frame whose z is the normal.
Array reflected(const paint::Paint& paint, const Array& light, const Array& view) {
  const paint::LobeFit& lobes = lobes_of(paint);
  const std::size_t count = triples(light, "light");
  if (triples(view, "view") != count) throw Failure("light and view have to have as many directions");
  const double gloss_deg = paint.gloss.empty() ? brdf::kGlossIncidence_deg : paint.gloss.front().angle_deg;
  const double* v = view.data();
  return each(light, "light", [&](const double* l) {
    const Vec3 to_light{l[0], l[1], l[2]}, to_viewer{v[0], v[1], v[2]};
    v += 3;
    return triple(brdf::coated_brdf(lobes, normalized(to_light), normalized(to_viewer), {0, 0, 1}, gloss_deg));
  });
}

py::dict metrics_of(const paint::Paint& paint) {
  const paint::PaintMetrics numbers = value_of(paint::metrics(paint));
  py::dict result;
  for (const paint::MetricColumn& column : paint::metric_columns()) result[column.name] = numbers.*column.value;
  return result;
}

// Lab at aspecular angles, by the curve that the paint states or that its readings make.
Array curve_of(const paint::Paint& paint, const Array& angles_deg) {
  paint::Appearance appearance;
  if (paint.appearance) {
    appearance = *paint.appearance;
  } else {
    if (!paint.measurement) throw Failure("paint \"" + paint.name + "\" has neither readings nor a curve");
    appearance = value_of(paint::appearance_from_rows(paint.measurement->rows)).appearance;
  }
  std::vector<std::array<double, 3>> rows;
  for (py::ssize_t i = 0; i < angles_deg.size(); ++i)
    rows.push_back(triple(paint::lab_at(appearance, std::abs(angles_deg.data()[i]))));
  return array_of(rows);
}

Array readings_of(const paint::Paint& paint) {
  std::vector<std::array<double, 3>> rows;
  if (paint.measurement)
    for (const paint::LabReading& row : paint.measurement->rows) rows.push_back(triple(row.lab));
  return array_of(rows);
}
std::vector<std::string> geometries_of(const paint::Paint& paint) {
  std::vector<std::string> names;
  if (paint.measurement)
    for (const paint::LabReading& row : paint.measurement->rows) names.push_back(paint::geometry_name(row.geometry));
  return names;
}

void write_paints(const std::string& path, const std::vector<paint::Paint>& paints) {
  auto writer = value_of(formats::PaintWriter::begin(value_of(OutputFile::create(path))));
  for (const paint::Paint& paint : paints) check(writer.write(paint));
  check(writer.finish());
}

std::vector<paint::Paint> fit_all(const std::vector<paint::Paint>& paints, const formats::Basis& basis,
                                  const std::string& method, std::optional<double> coat_index) {
  fit::FitOptions options;
  options.coat_index = coat_index;
  bool known = false;
  for (const auto each : {fit::FitMethod::kL1, fit::FitMethod::kL2, fit::FitMethod::kDeltaE})
    if (method == fit::fit_method_name(each)) options.method = each, known = true;
  if (!known) throw Failure("method \"" + method + "\": l1, l2 and deltae are known");
  const py::gil_scoped_release others_may_run;
  const fit::PaintFitter fitter(basis, options);
  std::vector<Result<fit::PaintFit>> made = fit::fits(fitter, paints);
  std::vector<paint::Paint> fitted = paints;
  for (std::size_t i = 0; i < paints.size(); ++i) {
    if (!made[i].ok()) throw Failure("paint \"" + paints[i].name + "\": " + made[i].error().message);
    fitted[i].lobes = made[i]->lobes;
    fitted[i].coat_index = made[i]->lobes.coat_index;
  }
  return fitted;
}

void add_paints(py::module_& module) {
  py::class_<paint::Lobe>(module, "Lobe")
      .def_readonly("exponent", &paint::Lobe::exponent)
      .def_property_readonly("directional_diffuse",
                             [](const py::object& self) {
                               return view_of(&self.cast<const paint::Lobe&>().directional_diffuse.x, {3}, self);
                             })
      .def_property_readonly(
          "gloss", [](const py::object& self) { return view_of(&self.cast<const paint::Lobe&>().gloss.x, {3}, self); });
  py::class_<paint::LobeFit>(module, "LobeFit")
      .def_readonly("coat_index", &paint::LobeFit::coat_index)
      .def_readonly("mean_de00", &paint::LobeFit::mean_de00)
      .def_readonly("max_de00", &paint::LobeFit::max_de00)
      .def_readonly("lobes", &paint::LobeFit::lobes)
      .def_property_readonly("diffuse", [](const py::object& self) {
        return view_of(&self.cast<const paint::LobeFit&>().diffuse.x, {3}, self);
      });
  py::class_<paint::Paint>(module, "Paint")
      .def_readonly("name", &paint::Paint::name)
      .def_readonly("code", &paint::Paint::code)
      .def_property_readonly("paint_class",
                             [](const paint::Paint& p) { return paint::paint_class_name(p.paint_class); })
      .def_property_readonly("illuminant", [](const paint::Paint& p) { return paint::condition_of(p).illuminant; })
      .def_property_readonly("observer_deg", [](const paint::Paint& p) { return paint::condition_of(p).observer_deg; })
      .def_property_readonly("geometries", geometries_of)
      .def_property_readonly("readings", readings_of)
      .def_readonly("lobes", &paint::Paint::lobes)
      .def_property_readonly("metrics", metrics_of)
      .def("curve", curve_of, py::arg("aspecular_deg"))
      .def("brdf", reflected, py::arg("light"), py::arg("view"))
      .def("__repr__", [](const paint::Paint& p) { return "<goniochrome.Paint \"" + p.name + "\">"; });
  py::class_<formats::Basis>(module, "Basis")
      .def(py::init([](std::vector<double> exponents, bool mirror, std::string name) {
             std::ranges::sort(exponents);
             return formats::Basis{std::move(name), std::move(exponents), mirror};
           }),
           py::arg("exponents"), py::arg("mirror") = true, py::arg("name") = "basis")
      .def_readonly("name", &formats::Basis::name)
      .def_readonly("mirror", &formats::Basis::mirror)
      .def_property_readonly("exponents", [](const py::object& self) {
        const auto& exponents = self.cast<const formats::Basis&>().exponents;
        return view_of(exponents.data(), {static_cast<py::ssize_t>(exponents.size())}, self);
      });
  module.def(
      "read_paints",
      [](const std::string& path) {
        std::vector<std::string> warnings;
        auto paints = value_of(formats::read_paints(path, &warnings));
        for (const std::string& warning : warnings) py::module_::import("warnings").attr("warn")(warning);
        return paints;
      },
      py::arg("path"));
  module.def("write_paints", write_paints, py::arg("path"), py::arg("paints"));
  module.def(
      "read_basis", [](const std::string& path) { return value_of(formats::read_basis(path)); }, py::arg("path"));
  module.def("fit", fit_all, py::arg("paints"), py::arg("basis"), py::arg("method") = "l1",
             py::arg("coat_index") = py::none());
}

void add_colors(py::module_& module) {
  module.def(
      "delta_e_2000", [](const Array& x, const Array& y) { return difference(x, y, color::delta_e_2000); },
      py::arg("x"), py::arg("y"));
  module.def(
      "delta_e_76", [](const Array& x, const Array& y) { return difference(x, y, color::delta_e_76); }, py::arg("x"),
      py::arg("y"));
  module.def(
      "lab_from_rgb",
      [](const Array& rgb, const std::string& illuminant, int observer_deg) {
        const color::Xyz white = white_of(illuminant, observer_deg);
        return each(rgb, "rgb", [&](const double* c) {
          return triple(color::lab_from_rgb({c[0], c[1], c[2]}, white));
        });
      },
      py::arg("rgb"), py::arg("illuminant") = "D65", py::arg("observer_deg") = 10);
  module.def(
      "rgb_from_lab",
      [](const Array& lab, const std::string& illuminant, int observer_deg) {
        const color::Xyz white = white_of(illuminant, observer_deg);
        return each(lab, "lab", [&](const double* c) {
          return triple(color::rgb_from_lab({c[0], c[1], c[2]}, white));
        });
      },
      py::arg("lab"), py::arg("illuminant") = "D65", py::arg("observer_deg") = 10);
  module.def(
      "directions",
      [](const std::vector<std::string>& names) {
        std::vector<std::array<double, 3>> lights, views;
        for (const std::string& name : names) {
          const auto [light, view] = paint::directions(value_of(paint::parse_geometry(name)));
          lights.push_back(triple(light));
          views.push_back(triple(view));
        }
        return py::make_tuple(array_of(lights), array_of(views));
      },
      py::arg("geometries"));
  module.def(
      "aspecular_deg",
      [](const std::string& name) { return paint::aspecular_angle_deg(value_of(paint::parse_geometry(name))); },
      py::arg("geometry"));
}

py::array texels_of(const py::object& self) {
  const auto& environment = self.cast<const envmap::Environment&>();
  return view_of(environment.values().data(), {environment.height(), environment.width(), 3}, self);
}

void add_environments(py::module_& module) {
  py::class_<envmap::Environment>(module, "Environment")
      .def_property_readonly("texels", texels_of)
      .def_property_readonly("layout",
                             [](const envmap::Environment& environment) {
                               using Layout = envmap::Environment::Layout;
                               switch (environment.layout()) {
                                 case Layout::kLatLong:
                                   return "lat-long";
                                 case Layout::kAngular:
                                   return "angular";
                                 case Layout::kCubeEdges:
                                   return "cube-edges";
                                 case Layout::kCube:
                                   break;
                               }
                               return "cube";
                             })
      .def("directions",
           [](const envmap::Environment& environment) {
             Array result({py::ssize_t{environment.height()}, py::ssize_t{environment.width()}, py::ssize_t{3}});
             double* out = result.mutable_data();
             for (int row = 0; row < environment.height(); ++row)
               for (int column = 0; column < environment.width(); ++column, out += 3) {
                 const auto direction = triple(environment.direction(column, row));
                 std::copy(direction.begin(), direction.end(), out);
               }
             return result;
           })
      .def("solid_angles", [](const envmap::Environment& environment) {
        Array result({py::ssize_t{environment.height()}, py::ssize_t{environment.width()}});
        double* out = result.mutable_data();
        for (int row = 0; row < environment.height(); ++row)
          for (int column = 0; column < environment.width(); ++column) *out++ = environment.solid_angle(column, row);
        return result;
      });
  module.def(
      "read_environment",
      [](const std::string& path) {
        return value_of(envmap::Environment::read(path, envmap::Environment::BadPixels::kError));
      },
      py::arg("path"));
  py::class_<envmap::PrefilteredLobe>(module, "PrefilteredLobe")
      .def_readonly("exponent", &envmap::PrefilteredLobe::exponent)
      .def_readonly("max_error", &envmap::PrefilteredLobe::max_error)
      .def_property_readonly("texels", [](const py::object& self) {
        const auto& lobe = self.cast<const envmap::PrefilteredLobe&>();
        const envmap::SphereGrid grid = envmap::map_grid(lobe.layout, lobe.map.size);
        if (grid.is_cube()) return view_of(lobe.map.texels.data(), {6, lobe.map.size, lobe.map.size, 3}, self);
        return view_of(lobe.map.texels.data(), {grid.height(), grid.width(), 3}, self);
      });
  py::class_<envmap::PrefilteredEnvironment>(module, "PrefilteredEnvironment")
      .def_readonly("source", &envmap::PrefilteredEnvironment::source)
      .def_readonly("diffuse", &envmap::PrefilteredEnvironment::diffuse)
      .def_readonly("mirror", &envmap::PrefilteredEnvironment::mirror)
      .def_property_readonly("lobes", [](py::object self) {
        py::list lobes;
        for (const envmap::PrefilteredLobe& lobe : self.cast<const envmap::PrefilteredEnvironment&>().lobes)
          lobes.append(py::cast(lobe, py::return_value_policy::reference_internal, self));
        return lobes;
      });
  module.def(
      "read_prefiltered", [](const std::string& path) { return value_of(envmap::read_env(path)); }, py::arg("path"));
}

}  // namespace

PYBIND11_MODULE(_core, module) {
  py::register_exception<Failure>(module, "Error", PyExc_ValueError);
  add_paints(module);
  add_colors(module);
  add_environments(module);
}

}  // namespace goniochrome::python
