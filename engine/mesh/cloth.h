#pragma once
// The simulation mesh: all garments of a scene in one set of vertices, with the flat rest shape per triangle corner.

#include "engine/scene/fabric.h"
#include "engine/types.h"

#include <string>
#include <vector>

namespace toile {

struct ClothPanel {
  int garment = 0;  ///< index into Scene::garments
  std::string name, label;
  int fabric = 0;          ///< index into Cloth::fabrics
  double edge_length = 0;  ///< target [m]
};

/// Two vertices that a seam joins; several pairs may chain (a corner where four panels meet).
struct SeamPair {
  int a, b;
  int seam;  ///< index into Cloth::seam_names
};

/// A vertex selected by name: every edge label, and every panel edge as "panel/edge-index" (pins need them).
struct LabelledVertices {
  int garment;
  std::string label;
  std::vector<int> vertices;  ///< in order along the edge
};

/// A triangle's edge opposite to its `corner`, between two held vertices, across which the tangent is prescribed: there
/// the triangle continues the plane through the edge and `tip`, a held vertex on the far side. A triangle across the
/// edge with that tip is what holds, and does not bend.
struct ClampedEdge {
  int triangle, corner, tip;
};

/// Where a vertex was placed by the scene. A sewn vertex has several.
struct PlacedVertex {
  int vertex;
  Vec3 at;  ///< [m]
};

/// An edge of the mesh that is not flat at rest, or not as stiff as the cloth: a pressed fold, a seam. The rest angle
/// is positive where the edge is a ridge seen from the right side of the triangle with the smaller index.
struct Crease {
  int v0, v1;
  double rest_angle = 0;        ///< [rad]
  double stiffness_factor = 1;  ///< of the hinge's bending stiffness
};

/// Before sewing, panels are apart and seam_pairs lists what is to be joined; merge_seams() (mesh/sewing.h) makes one
/// vertex of each joined set and leaves seam_pairs empty. A vertex then has one position and, through the triangles
/// around it, a flat position per panel.
struct Cloth {
  Positions x;                            ///< [m]
  std::vector<Triangle> triangles;        ///< outward (right side of the fabric) counter-clockwise
  std::vector<std::array<Vec2, 3>> flat;  ///< rest corners [m], drawn and turned by the grain: u weft, v warp;
                                          ///< signed area may be < 0
  std::vector<int> triangle_panel;        ///< index into panels
  std::vector<int> vertex_garment;        ///< index into Scene::garments
  std::vector<ClothPanel> panels;
  std::vector<Fabric> fabrics;
  std::vector<SeamPair> seam_pairs;
  std::vector<std::string> seam_names;  ///< "panelA/3 – panelB/5"
  std::vector<LabelledVertices> labels;
  std::vector<PlacedVertex> placed;  ///< before assembly moved anything; empty: where they are
  std::vector<ClampedEdge> clamps;
  std::vector<Crease> creases;
  std::vector<std::string> warnings;  ///< said once each, for the report
};

/// The smallest edge length of its panels [m]; at most 0.1.
double smallest_edge_length(const Cloth& cloth);

}  // namespace toile
