#pragma once
// Closest points between points, segments and triangles. Robust for degenerate input: every answer is finite, weights
// lie in [0, 1], and a triangle without area is treated as its edges, an edge without length as a point.

#include "engine/types.h"

namespace toile {

struct PointSegment {
  double t;                 ///< closest point (1 − t)·a + t·b, t in [0, 1]
  double squared_distance;  ///< [m²]
};
PointSegment point_segment(const Vec3& p, const Vec3& a, const Vec3& b);

struct PointTriangle {
  Vec3 weights;             ///< barycentric, of the closest point; all >= 0, sum 1
  double squared_distance;  ///< [m²]
};
/// Voronoi regions of the triangle: Ericson, Real-Time Collision Detection (2005), section 5.1.5.
PointTriangle point_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c);

struct SegmentSegment {
  double s;                 ///< closest point (1 − s)·a + s·b on the first segment
  double t;                 ///< closest point (1 − t)·c + t·d on the second
  double squared_distance;  ///< [m²]
};
/// The least of the interior solution and the four end-to-segment ones, which needs no tolerance to be right. Where the
/// segments are parallel and overlap, the middle of the overlap, so that s and t don't jump from end to end.
SegmentSegment segment_segment(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);

}  // namespace toile
