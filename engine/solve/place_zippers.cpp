#include "engine/solve/place_zippers.h"

#include "engine/mesh/pattern_pointer.h"
#include "engine/mesh/zippers.h"
#include "engine/scene/problem.h"
#include "engine/solve/edge_selection.h"
#include "engine/solve/panel_point.h"

#include <algorithm>
#include <map>

namespace toile {
namespace {

/// The triangles on the edges of the mesh, by the direction in which they run round them.
using DirectedEdges = std::map<std::array<int, 2>, std::size_t>;

DirectedEdges directed_edges(const Cloth& cloth) {
  DirectedEdges edges;
  for (std::size_t t = 0; t < cloth.triangles.size(); ++t)
    for (std::size_t c = 0; c < 3; ++c) edges[{cloth.triangles[t][c], cloth.triangles[t][(c + 1) % 3]}] = t;
  return edges;
}

std::size_t corner_of(const Triangle& triangle, int vertex) {
  return static_cast<std::size_t>(std::find(triangle.begin(), triangle.end(), vertex) - triangle.begin());
}

/// One side of a zipper from the bottom up.
struct Run {
  std::vector<int> vertices;
  std::vector<double> at;  ///< rest length from the bottom to each vertex [m]
};

Run measured(std::vector<int> vertices, const Cloth& cloth, const std::string& pointer) {
  const std::vector<FlatEdge> edges = edges_along(vertices, cloth);
  if (edges.empty() || edges.size() + 1 != vertices.size())
    throw InputError(pointer, "selects_no_edge", "A side of the zipper does not follow edges of the mesh.");
  Run run{std::move(vertices), {0}};
  for (const FlatEdge& edge : edges) run.at.push_back(run.at.back() + edge.length);
  return run;
}

/// Puts rigid ends onto one zipper.
class Ends {
 public:
  Ends(const Zipper& zipper, const Cloth& cloth, const DirectedEdges& edges, const SolverOptions& solver,
       const std::string& pointer, Trimmings& trimmings)
      : zipper_(zipper), cloth_(cloth), edges_(edges), solver_(solver), pointer_(pointer), trimmings_(trimmings) {}

  /// An end on a run, its middle at `middle` [m] from the bottom, on springs to both of its own ends on the chain and
  /// to the cloth on the sides that there are.
  void put(const ZipperEnd& end, const Run& run, double middle) {
    const double half = 0.5 * end.size.y();
    std::vector<Held> held = {{on_chain(run, middle - half), {0, -half}}, {on_chain(run, middle + half), {0, half}}};
    add_beside(end, run, middle, 0, held);
    place(end, held, on_chain(run, middle), run, middle);
  }

  /// The slider between a closed run below it and two open ones above, of the same length up to there.
  void put_slider(const std::array<Run, 2>& runs, double middle) {
    const ZipperEnd& end = zipper_.slider;
    const double half = 0.5 * end.size.y(), mouth = 0.25 * end.size.x();
    std::vector<Held> held = {{on_chain(runs[0], middle - half), {0, -half}}};
    add_beside(end, runs[0], middle - 0.5 * half, -0.5 * half, held);
    for (const Run& run : runs)
      held.push_back({on_chain(run, middle + half), {side_of(run, middle + half) * mouth, half}});
    place(end, held, on_chain(runs[0], middle), runs[0], middle - 0.5 * half);
  }

 private:
  /// A point of the cloth, and where it is in the end's frame.
  struct Held {
    PanelPoint point;
    Vec2 at;
  };
  /// Segment k of a run.
  struct Segment {
    std::size_t k;
    double along;  ///< share of it
  };

  Segment segment(const Run& run, double at) const {
    const std::size_t last = run.at.size() - 2;
    std::size_t k = 0;
    while (k < last && run.at[k + 1] < at) ++k;
    return {k, std::clamp((at - run.at[k]) / (run.at[k + 1] - run.at[k]), 0.0, 1.0)};
  }

  /// The triangle left (−1) or right (1) of a segment, seen from the right side of the cloth with the bottom below.
  const std::size_t* triangle_beside(const Run& run, std::size_t k, int side) const {
    const int from = run.vertices[k], to = run.vertices[k + 1];
    const auto found = edges_.find(side < 0 ? std::array<int, 2>{from, to} : std::array<int, 2>{to, from});
    return found == edges_.end() ? nullptr : &found->second;
  }
  /// On which side of an open run the cloth lies.
  int side_of(const Run& run, double at) const { return triangle_beside(run, segment(run, at).k, -1) ? -1 : 1; }

  PanelPoint on_chain(const Run& run, double at) const {
    const Segment s = segment(run, at);
    const std::size_t* triangle = triangle_beside(run, s.k, -1);
    if (!triangle) triangle = triangle_beside(run, s.k, 1);
    PanelPoint p{*triangle, {0, 0, 0}};
    p.weights[corner_of(cloth_.triangles[*triangle], run.vertices[s.k])] = 1 - s.along;
    p.weights[corner_of(cloth_.triangles[*triangle], run.vertices[s.k + 1])] = s.along;
    return p;
  }

  /// Points of the panels half the end's width from the run, which are at height `y` of the end.
  void add_beside(const ZipperEnd& end, const Run& run, double at, double y, std::vector<Held>& held) const {
    const Segment s = segment(run, at);
    for (const int side : {-1, 1}) {
      const std::size_t* triangle = triangle_beside(run, s.k, side);
      if (!triangle) continue;
      const Triangle& v = cloth_.triangles[*triangle];
      const auto& flat = cloth_.flat[*triangle];
      const Vec2 from = flat[corner_of(v, run.vertices[s.k])], to = flat[corner_of(v, run.vertices[s.k + 1])];
      const Vec2 tip = flat[3 - corner_of(v, run.vertices[s.k]) - corner_of(v, run.vertices[s.k + 1])];
      const Vec2 along = (to - from).normalized();
      const Vec2 inward = (tip - from - along * along.dot(tip - from)).normalized();
      const double off = 0.5 * end.size.x();
      const std::optional<PanelPoint> point =
          find_on_panel(cloth_, cloth_.triangle_panel[*triangle], (1 - s.along) * from + s.along * to + off * inward);
      if (!point)
        throw InputError(pointer_, "zipper_too_short", "The panel beside the zipper is narrower than an end.");
      held.push_back({*point, {side * off, y}});
    }
  }

  void place(const ZipperEnd& end, const std::vector<Held>& held, const PanelPoint& middle, const Run& run, double at) {
    const Segment s = segment(run, at);
    Vec3 normal = Vec3::Zero();
    double spacing = 0;
    for (const int side : {-1, 1}) {
      const std::size_t* triangle = triangle_beside(run, s.k, side);
      if (!triangle) continue;
      const Triangle& v = cloth_.triangles[*triangle];
      normal += (cloth_.x[v[1]] - cloth_.x[v[0]]).cross(cloth_.x[v[2]] - cloth_.x[v[0]]).normalized();
      spacing = std::max(spacing, layer_spacing(solver_, cloth_, cloth_.triangle_panel[*triangle]));
    }
    Mat3 axes;
    axes.col(1) = (cloth_.x[run.vertices[s.k + 1]] - cloth_.x[run.vertices[s.k]]).normalized();
    axes.col(0) = axes.col(1).cross(normal).normalized();
    axes.col(2) = axes.col(0).cross(axes.col(1));
    const double depth = 0.5 * (end.size.z() + spacing);
    const int index = static_cast<int>(trimmings_.trims.size());
    RigidTrim& trim = trimmings_.trims.emplace_back();
    trim.body = box_body(end.mass, end.size);
    trim.shape = box_shape(end.size);
    trim.friction = zipper_.friction;
    trim.start.center = position(cloth_, middle) + depth * axes.col(2);
    trim.start.orientation = Eigen::Quaterniond(axes).normalized();
    for (const Held& h : held) {
      AttachmentStencil& spring = trimmings_.attachments.emplace_back();
      spring.cloth = cloth_.triangles[h.point.triangle];
      spring.weights = h.point.weights;
      spring.trim = index;
      spring.point = {h.at.x(), h.at.y(), -depth};
      spring.stiffness = zipper_.thread_stiffness / static_cast<double>(held.size());
      spring.damping = zipper_.thread_damping;
    }
  }

  const Zipper& zipper_;
  const Cloth& cloth_;
  const DirectedEdges& edges_;
  const SolverOptions& solver_;
  const std::string& pointer_;
  Trimmings& trimmings_;
};

/// `share` of the zipper along the segments [begin, end) of a run, with the joints at their inner vertices and, where
/// `joined`, at the one from which they go on.
void add_tape(const Zipper& zipper, const Run& run, std::size_t begin, std::size_t end, double share, bool joined,
              Trimmings& trimmings) {
  for (std::size_t k = begin; k < end; ++k) {
    const double length = run.at[k + 1] - run.at[k];
    const std::array<int, 2> nodes = {run.vertices[k], run.vertices[k + 1]};
    trimmings.elastics.push_back({nodes, length, share * zipper.stiffness, zipper.damping});
    for (const int node : nodes) trimmings.masses.push_back({node, 0.5 * share * zipper.mass_per_length * length});
    if (k == 0 || (k == begin && !joined)) continue;
    trimmings.tapes.push_back({{run.vertices[k - 1], run.vertices[k], run.vertices[k + 1]},
                               0.5 * (run.at[k + 1] - run.at[k - 1]),
                               share * zipper.bending,
                               zipper.damping});
  }
}

void place_zipper(const Zipper& zipper, const std::array<Run, 2>& runs, Ends& ends, const std::string& pointer,
                  Trimmings& trimmings) {
  if (runs[0].vertices.size() != runs[1].vertices.size() || runs[0].vertices.size() < 2)
    throw InputError(pointer, "zipper_side", "A seam joins vertices along one side of the zipper.");
  const std::size_t segments = runs[0].vertices.size() - 1;
  std::size_t closed = 0;
  while (closed < segments && runs[0].vertices[closed + 1] == runs[1].vertices[closed + 1]) ++closed;
  add_tape(zipper, runs[0], 0, closed, 1, false, trimmings);
  for (const Run& run : runs) add_tape(zipper, run, closed, segments, 0.5, true, trimmings);

  const double length = runs[0].at.back(), slider = 0.5 * zipper.slider.size.y(), stop = 0.5 * zipper.stop.size.y();
  if (std::max(slider, stop) > 0.25 * std::min(length, runs[1].at.back()))
    throw InputError(pointer, "zipper_too_short", "The zipper is shorter than twice the longest of its ends.");
  if (closed == 0) {
    ends.put(zipper.slider, runs[0], slider);
  } else if (closed == segments) {
    ends.put(zipper.slider, runs[0], length - slider);
  } else {
    ends.put_slider(runs, std::clamp(runs[0].at[closed], slider, length - slider));
  }
  ends.put(zipper.stop, runs[1], stop);
  if (closed == segments) return;
  for (const Run& run : runs) ends.put(zipper.stop, run, run.at.back() - stop);
}

}  // namespace

void place_zippers(const Scene& scene, const Cloth& sewn, Trimmings& trimmings) {
  if (std::all_of(scene.garments.begin(), scene.garments.end(), [](const Garment& g) { return g.zippers.empty(); }))
    return;
  const DirectedEdges edges = directed_edges(sewn);
  for (std::size_t g = 0; g < scene.garments.size(); ++g)
    for (std::size_t z = 0; z < scene.garments[g].zippers.size(); ++z) {
      const Zipper& zipper = scene.garments[g].zippers[z];
      const std::string pointer = garment_pointer(g) + "/zippers/" + std::to_string(z);
      const std::array<std::vector<int>, 2> sides = zipper_sides(sewn, static_cast<int>(g), z);
      const std::array<Run, 2> runs = {measured(sides[0], sewn, pointer), measured(sides[1], sewn, pointer)};
      Ends ends(zipper, sewn, edges, scene.solver, pointer, trimmings);
      place_zipper(zipper, runs, ends, pointer, trimmings);
    }
}

}  // namespace toile
