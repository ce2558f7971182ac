#include "render/camera.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace toile {
namespace {

constexpr double kHalfFieldTangent = 12.0 / 85.0;                 // half of 24 mm over the focal length
constexpr double kMargin = 0.92;                                  // share of the picture that the subject may fill
constexpr double kSmallestRadius = 0.01;                          // [m] a single point gets a picture, too
constexpr double kThreeQuarterTurn = 40, kThreeQuarterRise = 12;  // [°]

void grow(Frame& box, bool& empty, const Vec3& point) {
  box.low = empty ? point : box.low.cwiseMin(point);
  box.high = empty ? point : box.high.cwiseMax(point);
  empty = false;
}

// From the subject to the eye.
Vec3 eye_direction(View view) {
  constexpr double degree = std::numbers::pi / 180;
  const double turn = kThreeQuarterTurn * degree, rise = kThreeQuarterRise * degree;
  switch (view) {
    case View::front:
      return Vec3::UnitZ();
    case View::back:
      return -Vec3::UnitZ();
    case View::left:
      return Vec3::UnitX();
    case View::right:
      return -Vec3::UnitX();
    case View::top:
      return Vec3::UnitY();
    case View::three_quarter:
      break;
  }
  return {std::sin(turn) * std::cos(rise), std::sin(rise), std::cos(turn) * std::cos(rise)};
}

Eigen::Matrix4f view_matrix(const Vec3& right, const Vec3& up, const Vec3& back, const Vec3& eye) {
  Eigen::Matrix4d matrix = Eigen::Matrix4d::Identity();
  matrix.row(0) << right.transpose(), -right.dot(eye);
  matrix.row(1) << up.transpose(), -up.dot(eye);
  matrix.row(2) << back.transpose(), -back.dot(eye);
  return matrix.cast<float>();
}

}  // namespace

Frame frame_of(const Subject& subject) {
  Frame garment;
  bool empty = true;
  for (const Triangle& triangle : subject.triangles)
    for (const int v : triangle) grow(garment, empty, subject.vertices[v]);
  if (!subject.body || subject.body->triangles.empty()) return garment;
  const double reach = empty ? 1e30 : kBodyReach * std::max(2 * garment.radius(), kSmallestRadius);
  const Vec3 low = garment.low.array() - reach, high = garment.high.array() + reach;
  Frame all = garment;
  for (const Triangle& triangle : subject.body->triangles)
    for (const int v : triangle) {
      const Vec3& point = subject.body->vertices[v];
      grow(all, empty, reach < 1e30 ? Vec3(point.cwiseMax(low).cwiseMin(high)) : point);
    }
  return all;
}

Camera camera_for(View view, const Subject& subject, const Frame& frame, int width, int height, int reserved) {
  Camera camera;
  camera.back = eye_direction(view);
  const Vec3 pole = view == View::top ? Vec3(-Vec3::UnitZ()) : Vec3::UnitY();
  camera.right = pole.cross(camera.back).normalized();
  camera.up = camera.back.cross(camera.right);
  const double shorter = std::min(width, height);
  camera.tangent_x = kHalfFieldTangent * width / shorter;
  camera.tangent_y = kHalfFieldTangent * height / shorter;
  camera.shift_x = -double(reserved) / width;

  const double reach_x = kMargin * camera.tangent_x * (1 - double(reserved) / width);
  const double reach_y = kMargin * camera.tangent_y;
  const Vec3 centre = frame.centre();
  const double radius = std::max(frame.radius(), kSmallestRadius);
  double distance = radius;  // the least that keeps the eye out of the subject
  const auto include = [&](const Vec3& point) {
    const Vec3 p = point.cwiseMax(frame.low).cwiseMin(frame.high) - centre;
    const double needed = std::max(std::abs(p.dot(camera.right)) / reach_x, std::abs(p.dot(camera.up)) / reach_y);
    distance = std::max(distance, p.dot(camera.back) + needed);
  };
  for (const Triangle& triangle : subject.triangles)
    for (const int v : triangle) include(subject.vertices[v]);
  if (subject.body)
    for (const Triangle& triangle : subject.body->triangles)
      for (const int v : triangle) include(subject.body->vertices[v]);
  distance = std::max(distance, 1.2 * radius);

  camera.eye = distance * camera.back;
  camera.view = view_matrix(camera.right, camera.up, camera.back, camera.eye);
  const double near = std::max(0.05 * distance, distance - 3 * radius), far = distance + 3 * radius;
  Eigen::Matrix4d projection = Eigen::Matrix4d::Zero();
  projection(0, 0) = 1 / camera.tangent_x;
  projection(0, 2) = -camera.shift_x;
  projection(1, 1) = 1 / camera.tangent_y;
  projection(2, 2) = -(far + near) / (far - near);
  projection(2, 3) = -2 * far * near / (far - near);
  projection(3, 2) = -1;
  camera.projection = projection.cast<float>();
  return camera;
}

KeyLight key_light(const Camera& camera, double radius) {
  KeyLight light;
  // Seen from above, a steeper light: its shadow on the ground would be longer than the picture.
  const bool from_above = camera.back.y() > 0.9;
  light.towards = from_above ? (-0.32 * camera.right + 0.38 * camera.up + 0.87 * camera.back).normalized()
                             : (-0.55 * camera.right + 0.62 * camera.up + 0.62 * camera.back).normalized();
  light.fill = (0.80 * camera.right + 0.10 * camera.up + 0.55 * camera.back).normalized();
  const double reach = std::max(radius, kSmallestRadius);
  const Vec3 side =
      (std::abs(light.towards.y()) < 0.9 ? Vec3::UnitY() : Vec3::UnitZ()).cross(light.towards).normalized();
  light.view = view_matrix(side, light.towards.cross(side), light.towards, 2 * reach * light.towards);
  // Depth from the near side of the subject to well behind it: the ground's far part lies there.
  const double near = 0.5 * reach, far = 6 * reach;
  Eigen::Matrix4d projection = Eigen::Matrix4d::Identity();
  projection(0, 0) = projection(1, 1) = 1 / (1.02 * reach);
  projection(2, 2) = -2 / (far - near);
  projection(2, 3) = -(far + near) / (far - near);
  light.projection = projection.cast<float>();
  return light;
}

}  // namespace toile
