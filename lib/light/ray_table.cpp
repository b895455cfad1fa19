#include "light/private/ray_table.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/parallel.hpp"
#include "model/circle.hpp"
#include "optics/skew_ray.hpp"

namespace vam::light {

namespace {

constexpr double turn_rad = 2 * std::numbers::pi;
constexpr int least_directions = 1440;  // alpha in steps of at most 0.25 deg: column to 1e-3 at 400 columns radius
constexpr int samples_per_step = 8;     // rays per step of alpha where the map folds
constexpr int most_sheets = 4;          // front; rear: fold, middle, fold
constexpr double rim = 1 - 1e-9;        // rays at the very rim graze the glass and carry no light
constexpr double middle_height = 0.6;   // of the largest: where the polynomials are exact besides 0 and 1

/// The polynomial in z^2 that takes these values at z = 0, middle_height and 1 (in units of the largest height).
std::array<float, 3> even_fit(double at_0, double at_middle, double at_1) {
  constexpr double m = middle_height * middle_height;
  const double a = (at_middle - at_0) / m;  // c1 + c2 m
  const double b = at_1 - at_0;             // c1 + c2
  const double c2 = (b - a) / (1 - m);
  return {static_cast<float>(at_0), static_cast<float>(b - c2), static_cast<float>(c2)};
}

float value(const std::array<float, 3>& even, float z2) { return even[0] + z2 * (even[1] + z2 * even[2]); }

}  // namespace

// Level rays on a circle of the lab: everything at angle b from the ray's own normal.
struct RayTable::Light {
  const Setup& setup;
  double edge_mm;
  double reach_mm;

  struct Point {
    double alpha = 0;
    double alpha_rate = 1;  // d alpha / d b = 1 - u (d delta / d x_p) / J
    double x_p_mm = 0;
    double strength = 0;  // T / J e^{-mu s}, still per d b
    optics::ChiefRay ray;
    double u_mm = 0;
  };

  [[nodiscard]] double left(double offset_mm, double u_mm, double steepness) const {
    const double s = model::half_chord(edge_mm, offset_mm) + u_mm;
    return std::exp(-setup.absorption_per_mm * s * steepness);
  }

  [[nodiscard]] Point at(double r, double b) const {
    const double t = std::clamp(r * std::cos(b), -rim * reach_mm, rim * reach_mm);
    const double u = r * std::sin(b);
    const double x_p = optics::column_of(setup.view, t).value_or(0);
    const optics::ChiefRay ray = optics::chief_ray(setup.view, x_p);
    return {b + ray.delta_rad,
            1 - u * ray.delta_rate / ray.jacobian,
            x_p,
            ray.transmittance / ray.jacobian * left(t, u, 1),
            ray,
            u};
  }

  /// At the rim rays crowd without bounds, and carry next to nothing: a voxel is read there over fewer columns than it
  /// covers.
  [[nodiscard]] double spacing(double exact) const {
    constexpr double most = 2;  // of that on the axis
    return std::min(exact, most / optics::chief_ray(setup.view, 0).jacobian);
  }

  /// d z_p / d z of low rays at depth u.
  [[nodiscard]] double low_zoom(double x_p_mm, double u_mm) const {
    constexpr double low_mm = 1e-3;
    const optics::SkewRay ray = optics::skew_ray(setup.view, x_p_mm, low_mm);
    return ray.hits ? low_mm / ray.z_mm(u_mm) : 1.0;
  }
};

RayTable::RayTable(const Setup& setup)
    : phases((least_directions + setup.angles - 1) / setup.angles),
      directions(setup.angles * phases),
      reach_mm(optics::reach_mm(setup.view)),
      edge_mm(optics::resin_radius_mm(setup.view)),
      setup_(setup),
      climbs_(setup.view.rows_lens_mm.has_value()) {
  setup_.height_mm = std::max(setup.height_mm, 1e-3);
  const Light light{setup_, edge_mm, reach_mm};
  const double inside = std::min(reach_mm * (climbs_ ? 0.9995 : rim), std::max(setup.r_max_mm, setup.pitch_mm));
  inner.rows = std::max(2, static_cast<int>(std::ceil(inside / setup.pitch_mm)) + 1);
  inner.pitch_mm = inside / (inner.rows - 1);
  const double beyond = std::min(edge_mm, setup.r_max_mm) - reach_mm;
  if (beyond > 0) {
    outer.sheets = most_sheets;
    outer.rows = static_cast<int>(std::ceil(2 * beyond / setup.pitch_mm));  // nearest row: half the pitch
    outer.pitch_mm = beyond / outer.rows;
    outer.first_mm = reach_mm + 0.5 * outer.pitch_mm;
    outer.first_row = inner.rows;
  }
  nodes_.resize(static_cast<std::size_t>(inner.rows + outer.rows * outer.sheets) * directions);
  parallel_for(inner.rows, [&](int row) { fill_inner_row(light, row); });
  parallel_for(outer.rows, [&](int row) { fill_outer_row(light, row); });
}

void RayTable::fill_inner_row(const Light& light, int row) {
  const double r = row * inner.pitch_mm;
  double b = 0;
  for (int index = 0; index < directions; ++index) {
    const double alpha = setup_.sense * index * turn_rad / directions;
    // alpha(b) is monotone here: a few steps. Halving guards the rim, where delta is steepest.
    Light::Point point = light.at(r, b);
    for (int step = 0; step < 60 && std::abs(alpha - point.alpha) > 1e-12; ++step) {
      const double limit = 0.25 / (1 + step);
      b += std::clamp((alpha - point.alpha) / point.alpha_rate, -limit, limit);
      point = light.at(r, b);
    }
    Node& to = row_of(inner, row, 0)[index];
    const double strength = point.strength / point.alpha_rate;
    const double spacing = light.spacing(1 / (point.ray.jacobian * point.alpha_rate));
    to.cosine = static_cast<float>(std::cos(point.ray.delta_rad));
    to.sine = static_cast<float>(std::sin(point.ray.delta_rad));
    if (!climbs_) {
      to.x_p = even_fit(point.x_p_mm, point.x_p_mm, point.x_p_mm);
      to.row = {1, 0, 0};
      to.strength = even_fit(strength, strength, strength);
      to.spacing = even_fit(spacing, spacing, spacing);
      continue;
    }
    const double zoom = light.low_zoom(point.x_p_mm, point.u_mm);
    // At the rim, where level rays still pass, those that climb may not: there they carry nothing.
    struct High {
      double x_p, row, strength, spacing;
    } high[2];
    const double x = r * std::cos(alpha);
    const double y = r * std::sin(alpha);
    for (const int level : {0, 1}) {
      const double z = setup_.height_mm * (level == 0 ? middle_height : 1.0);
      const optics::RayAt found = optics::ray_through(setup_.view, x, y, z, point.x_p_mm, z * zoom);
      const optics::SkewRay& ray = found.ray;
      const double u = y * std::cos(ray.delta_rad) - x * std::sin(ray.delta_rad);
      high[level] = ray.hits ? High{found.x_p_mm, found.z_p_mm / z,
                                    ray.transmittance * found.density * light.left(ray.offset_mm, u, ray.steepness()),
                                    light.spacing(found.spacing)}
                             : High{point.x_p_mm, zoom, 0, spacing};
    }
    to.x_p = even_fit(point.x_p_mm, high[0].x_p, high[1].x_p);
    to.row = even_fit(zoom, high[0].row, high[1].row);
    to.strength = even_fit(strength * zoom, high[0].strength, high[1].strength);
    to.spacing = even_fit(spacing, high[0].spacing, high[1].spacing);
  }
}

void RayTable::fill_outer_row(const Light& light, int row) {
  const double r = outer.first_mm + row * outer.pitch_mm;
  const double open = std::acos(std::min(1.0, rim * reach_mm / r));  // rays reach b in (open, pi - open) and opposite
  struct Cell {
    double strength = 0;
    double x_p = 0, zoom = 0, cosine = 0, sine = 0, spacing = 0;  // weighted by strength
  };
  std::array<std::vector<Cell>, most_sheets> sheets;
  for (auto& sheet : sheets) sheet.resize(directions);

  const double arc = std::numbers::pi - 2 * open;
  const int samples = std::max(8, static_cast<int>(std::ceil(samples_per_step * directions * arc / turn_rad)));
  const double step = arc / samples;
  for (const bool front : {true, false}) {  // light enters at u < 0
    int sheet = front ? 0 : 1;
    bool rising = true;
    for (int k = 0; k < samples; ++k) {
      const double b = (front ? -std::numbers::pi : 0.0) + open + (k + 0.5) * step;
      const Light::Point point = light.at(r, b);
      if (k == 0) rising = point.alpha_rate > 0;
      if ((point.alpha_rate > 0) != rising) {  // a fold
        rising = !rising;
        sheet = std::min(sheet + 1, most_sheets - 1);
      }
      const double zoom = climbs_ ? light.low_zoom(point.x_p_mm, point.u_mm) : 1.0;
      const double light_here = point.strength * zoom * step * directions / turn_rad;
      const double place = setup_.sense * point.alpha * directions / turn_rad;
      const double below = std::floor(place);
      for (const int side : {0, 1}) {  // shared by the two nearest directions
        const double share = light_here * (side == 1 ? place - below : 1 - (place - below));
        const int index = (static_cast<int>(below) + side) % directions;
        Cell& cell = sheets[sheet][(index + directions) % directions];
        cell.strength += share;
        cell.x_p += share * point.x_p_mm;
        cell.zoom += share * zoom;
        cell.cosine += share * std::cos(point.ray.delta_rad);
        cell.sine += share * std::sin(point.ray.delta_rad);
        cell.spacing += share * light.spacing(1 / point.ray.jacobian);
      }
    }
  }
  for (int sheet = 0; sheet < most_sheets; ++sheet) {
    const std::vector<Cell>& cells = sheets[sheet];
    const auto cell = [&](int index) { return cells[(index + directions) % directions]; };
    for (int index = 0; index < directions; ++index) {
      // A direction without a ray takes its neighbour's, so that interpolation to it only fades.
      Cell source = cell(index);
      for (const int neighbour : {-1, 1}) {
        if (source.strength == 0) source = cell(index + neighbour);
      }
      Node& to = row_of(outer, row, sheet)[index];
      if (!(source.strength > 0)) continue;
      const auto mean = [&](double sum) { return static_cast<float>(sum / source.strength); };
      to.x_p = {mean(source.x_p), 0, 0};
      to.row = {mean(source.zoom), 0, 0};
      to.spacing = {mean(source.spacing), 0, 0};
      to.cosine = mean(source.cosine);
      to.sine = mean(source.sine);
      to.strength = {static_cast<float>(cell(index).strength), 0, 0};
    }
  }
}

void RayTable::at_height(double z_mm, const RayScale& scale, RayNodes& nodes) const {
  const int rows = inner.rows + outer.rows * outer.sheets;
  nodes.resize(rows * static_cast<std::size_t>(directions + 1));
  const auto z2 = static_cast<float>((z_mm / setup_.height_mm) * (z_mm / setup_.height_mm));
  const auto columns_per_mm = static_cast<float>(scale.columns_per_mm);
  const auto column_origin = static_cast<float>(scale.column_origin);
  const auto row_rate = static_cast<float>(scale.rows_per_mm * z_mm);
  const auto row_origin = static_cast<float>(scale.row_origin);
  const auto rows_per_slice = static_cast<float>(scale.rows_per_slice);
  const auto columns_per_voxel = static_cast<float>(scale.columns_per_voxel);
  parallel_for(rows, [&](int row) {
    const Node* from = nodes_.data() + static_cast<std::ptrdiff_t>(row) * directions;
    RayNode* to = nodes.data() + static_cast<std::ptrdiff_t>(row) * (directions + 1);
    for (int i = 0; i < directions; ++i) {
      const Node& node = from[i];
      const float g = value(node.row, z2);
      const float g_rate = 2 * z2 * (node.row[1] + 2 * z2 * node.row[2]);  // z dg/dz
      to[i] = {columns_per_mm * value(node.x_p, z2) + column_origin,
               row_rate * g + row_origin,
               rows_per_slice * (g + g_rate),
               std::max(0.0F, value(node.strength, z2)),
               columns_per_voxel * value(node.spacing, z2),
               node.cosine,
               node.sine,
               0};
    }
    to[directions] = to[0];
  });
}

double RayTable::drift_mm(double from_mm, double to_mm, double r_mm) const {
  const auto square = [&](double z) { return static_cast<float>((z / setup_.height_mm) * (z / setup_.height_mm)); };
  constexpr double counts = 0.95;  // of the reach: at the rim rays drift without bounds, and carry next to nothing
  const int row =
      std::min(inner.rows - 1, static_cast<int>(std::ceil(std::min(r_mm, counts * reach_mm) / inner.pitch_mm)));
  const Node* nodes = nodes_.data() + static_cast<std::ptrdiff_t>(row) * directions;
  float most = 0;
  for (int i = 0; i < directions; ++i) {
    const Even& x_p = nodes[i].x_p;
    most = std::max(most, std::abs(value(x_p, square(to_mm)) - value(x_p, square(from_mm))));
  }
  return static_cast<double>(most);
}

}  // namespace vam::light
