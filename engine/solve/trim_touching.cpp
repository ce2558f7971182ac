#include "engine/solve/trim_touching.h"

#include "engine/geometry/body_field.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace toile {
namespace {

constexpr int kMostPieces = 16;         // of an edge
constexpr double kLeastSpacing = 1e-3;  // [m] of points on the cloth
constexpr double kStretch = 1.25;       // cloth that is stretched farther may be asked at too few points
enum Feature : std::uint64_t { vertex, edge, triangle, body };

std::uint64_t feature_key(Feature kind, int index, int sample) {
  return (static_cast<std::uint64_t>(kind) << 42) | (static_cast<std::uint64_t>(index) << 10) |
         static_cast<std::uint64_t>(sample);
}

std::uint64_t contact_key(int trim, std::uint64_t feature) {
  return (static_cast<std::uint64_t>(trim) << 44) | feature;
}

int pieces(double length, double spacing) {
  return std::clamp(static_cast<int>(std::ceil(length / spacing)), 1, kMostPieces);
}

std::vector<int> unique_sorted(std::vector<int> list) {
  std::sort(list.begin(), list.end());
  list.erase(std::unique(list.begin(), list.end()), list.end());
  return list;
}

}  // namespace

TrimTouching::TrimTouching(const Cloth& cloth, const std::vector<RigidTrim>& trims, const TouchingOptions& options)
    : trims_(trims), body_(options.body) {
  double smallest = std::numeric_limits<double>::infinity();
  for (const RigidTrim& trim : trims)
    if (trim.shape.solid) smallest = std::min(smallest, trim.shape.size);
  if (std::isinf(smallest)) {
    trims_.clear();
    return;
  }
  mesh_ = make_collision_mesh(cloth, options.contact_distance);
  const double spacing = std::max(kLeastSpacing, 0.5 * smallest);
  std::map<std::pair<int, int>, double> rest_length;
  for (std::size_t t = 0; t < cloth.triangles.size(); ++t) {
    double longest = 0;
    for (std::size_t c = 0; c < 3; ++c) {
      const std::size_t d = (c + 1) % 3;
      const double length = (cloth.flat[t][d] - cloth.flat[t][c]).norm();
      double& of_edge = rest_length[std::minmax(cloth.triangles[t][c], cloth.triangles[t][d])];
      of_edge = std::max(of_edge, length);
      longest = std::max(longest, length);
    }
    triangle_pieces_.push_back(pieces(longest, spacing));
    longest_ = std::max(longest_, longest);
  }
  edges_at_.resize(cloth.x.size());
  triangles_at_.resize(cloth.x.size());
  for (std::size_t e = 0; e < mesh_.edges.size(); ++e) {
    const auto [a, b] = mesh_.edges[e];
    edge_pieces_.push_back(pieces(rest_length.at({a, b}), spacing));
    for (int v : {a, b}) edges_at_[v].push_back(static_cast<int>(e));
  }
  for (std::size_t t = 0; t < mesh_.triangles.size(); ++t)
    for (int v : mesh_.triangles[t]) triangles_at_[v].push_back(static_cast<int>(t));
}

void TrimTouching::append_samples(int trim, const Positions& x, const Vec3& center,
                                  std::vector<Sample>& samples) const {
  const double reach = trims_[trim].shape.reach + kMargin;
  std::vector<int> edges, triangles;
  for (int v = 0; v < static_cast<int>(edges_at_.size()); ++v) {
    const double distance = (x[v] - center).norm();
    if (distance > reach + kStretch * longest_ + mesh_.wanted_distance[v]) continue;
    if (distance < reach + mesh_.wanted_distance[v]) samples.push_back({{v}, {1}, 1, feature_key(vertex, v, 0)});
    edges.insert(edges.end(), edges_at_[v].begin(), edges_at_[v].end());
    triangles.insert(triangles.end(), triangles_at_[v].begin(), triangles_at_[v].end());
  }
  for (int e : unique_sorted(std::move(edges))) {
    const auto [a, b] = mesh_.edges[e];
    const int n = edge_pieces_[e];
    for (int i = 1; i < n; ++i) {
      const double along = static_cast<double>(i) / n;
      samples.push_back({{a, b}, {1 - along, along}, 2, feature_key(edge, e, i)});
    }
  }
  for (int t : unique_sorted(std::move(triangles))) {
    const int n = triangle_pieces_[t];
    for (int i = 1; i < n; ++i)
      for (int j = 1; i + j < n; ++j)
        samples.push_back({mesh_.triangles[t],
                           {static_cast<double>(n - i - j) / n, static_cast<double>(i) / n, static_cast<double>(j) / n},
                           3,
                           feature_key(triangle, t, kMostPieces * i + j)});
  }
}

void TrimTouching::recall(TrimContact& c, const Vec3& p) const {
  c.contact.anchor = p;
  const auto found = stretched_.find(c.contact.key);
  if (found == stretched_.end()) return;
  const Vec3& u = found->second;
  c.contact.anchor -= u - c.contact.normal * c.contact.normal.dot(u);
}

std::vector<TrimContact> TrimTouching::detect(const Positions& x, const std::vector<RigidState>& states) const {
  std::vector<TrimContact> contacts;
  for (int t = 0; t < static_cast<int>(trims_.size()); ++t) {
    const TrimShape& shape = trims_[t].shape;
    if (!shape.solid) continue;
    const Vec3& center = states[t].center;
    const Mat3 orientation = states[t].orientation.toRotationMatrix();
    std::vector<Sample> samples;
    append_samples(t, x, center, samples);
    for (const Sample& sample : samples) {
      Vec3 at = Vec3::Zero();
      double distance = std::numeric_limits<double>::infinity();
      for (int i = 0; i < sample.count; ++i) {
        at += sample.weights[i] * x[sample.nodes[i]];
        const int v = sample.nodes[i];
        distance = std::min({distance, 0.5 * mesh_.wanted_distance[v], 0.5 * mesh_.distance_limit[v]});
      }
      const Vec3 in_trim = orientation.transpose() * (at - center);
      if (in_trim.norm() > shape.reach + distance + kMargin) continue;
      const FieldSample field = shape.solid->sample(in_trim);
      if (field.distance > distance + kMargin) continue;
      TrimContact& c = contacts.emplace_back();
      c.trim = t;
      c.point = in_trim;
      c.contact.count = sample.count;
      for (int i = 0; i < sample.count; ++i) {
        c.contact.nodes[i] = sample.nodes[i];
        c.contact.weights[i] = sample.weights[i];
      }
      c.contact.normal = orientation * field.normal;
      c.contact.offset = -field.distance;
      c.contact.distance = distance;
      c.contact.friction = trims_[t].friction;
      c.contact.key = contact_key(t, sample.feature);
      recall(c, Vec3::Zero());
    }
    if (!body_ || body_->distance(center) > shape.reach + kMargin) continue;
    for (std::size_t k = 0; k < shape.points.size(); ++k) {
      const Vec3 at = center + orientation * shape.points[k];
      const BodyField::Sample field = body_->sample(at);
      if (field.distance > kMargin) continue;
      TrimContact& c = contacts.emplace_back();
      c.trim = t;
      c.side = 1;
      c.point = shape.points[k];
      c.contact.normal = field.normal;
      c.contact.offset = field.normal.dot(at) - field.distance;
      c.contact.friction = trims_[t].friction;
      c.contact.key = contact_key(t, feature_key(body, static_cast<int>(k), 0));
      recall(c, at);
    }
  }
  return contacts;
}

void TrimTouching::remember(const std::vector<TrimContact>& contacts, const Positions& x,
                            const std::vector<RigidState>& states) {
  stretched_.clear();
  for (const TrimContact& c : contacts) {
    StencilPoints<3> cloth;
    for (int i = 0; i < c.contact.count; ++i) cloth[i] = x[c.contact.nodes[i]];
    const RigidState& trim = states[c.trim];
    const Vec3 p = trim_contact_state(c, cloth, trim.center, trim.orientation.toRotationMatrix(), 1).point;
    if (c.contact.normal.dot(p) - c.contact.offset >= c.contact.distance) continue;
    stretched_.emplace(c.contact.key, p - c.contact.anchor);
  }
}

}  // namespace toile
