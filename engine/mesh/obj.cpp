#include "engine/mesh/obj.h"

#include "engine/scene/problem.h"

#include <charconv>
#include <cmath>
#include <map>
#include <optional>
#include <system_error>
#include <tuple>

namespace toile {
namespace {

constexpr std::string_view kBlank = " \t\r\v\f";

class ObjReader {
 public:
  explicit ObjReader(const std::string& pointer) : pointer_(pointer) {}

  TriangleMesh read(std::string_view text) {
    constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
    if (text.substr(0, kByteOrderMark.size()) == kByteOrderMark) text.remove_prefix(kByteOrderMark.size());
    while (!text.empty()) {
      const std::size_t end = text.find('\n');
      ++line_;
      read_line(text.substr(0, end));
      text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
    }
    if (!every_face_has_uv_) mesh_.corner_uv.clear();
    if (!any_group_) {
      mesh_.triangle_group.clear();
      mesh_.group_names.clear();
    }
    check_stitches();
    return std::move(mesh_);
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw InputError(pointer_, "bad_mesh_file", "line " + std::to_string(line_) + ": " + what);
  }

  static std::string_view next_word(std::string_view& rest) {
    const std::size_t start = rest.find_first_not_of(kBlank);
    if (start == std::string_view::npos) {
      rest = {};
      return {};
    }
    rest.remove_prefix(start);
    const std::size_t length = std::min(rest.find_first_of(kBlank), rest.size());
    const std::string_view word = rest.substr(0, length);
    rest.remove_prefix(length);
    return word;
  }

  double number(std::string_view& rest, const char* what) const {
    std::string_view word = next_word(rest);
    if (!word.empty() && word.front() == '+') word.remove_prefix(1);
    double value = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    // A denormal or an overflow: the first is zero for any garment, the second is refused below.
    if (error == std::errc::result_out_of_range) value = 0;
    if (word.empty() || (error != std::errc() && error != std::errc::result_out_of_range) ||
        end != word.data() + word.size()) {
      fail(std::string(what) + " needs a number");
    }
    const std::size_t exponent = word.find_first_of("eE");
    const bool overflow = error == std::errc::result_out_of_range &&
                          (exponent == std::string_view::npos || word.substr(exponent + 1).front() != '-');
    if (overflow || !std::isfinite(value)) fail(std::string(what) + " holds a number that is not finite");
    return value;
  }

  std::optional<long> integer(std::string_view word) const {
    long value = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (word.empty() || error != std::errc() || end != word.data() + word.size()) return std::nullopt;
    return value;
  }

  /// Index from 0 of a face's reference, which counts from 1 or, when negative, back from the latest.
  int resolve(std::string_view word, std::size_t count, const char* what) const {
    const std::optional<long> index = integer(word);
    if (!index) fail(std::string("a face's ") + what + " index is not a whole number");
    const long resolved = *index < 0 ? static_cast<long>(count) + *index : *index - 1;
    if (*index == 0 || resolved < 0 || resolved >= static_cast<long>(count)) {
      fail(std::string("a face names a ") + what + " that is not there");
    }
    return static_cast<int>(resolved);
  }

  void read_line(std::string_view line) {
    line = line.substr(0, line.find('#'));
    const std::string_view keyword = next_word(line);
    if (keyword == "v") {
      if (mesh_.vertices.size() >= kMaxMeshVertices) fail("more than two million vertices");
      const double x = number(line, "v"), y = number(line, "v"), z = number(line, "v");
      mesh_.vertices.emplace_back(x, y, z);
    } else if (keyword == "vt") {
      if (uvs_.size() >= 3 * kMaxMeshVertices) fail("more than six million texture coordinates");
      const double u = number(line, "vt"), v = number(line, "vt");
      uvs_.emplace_back(u, v);
    } else if (keyword == "f") {
      read_face(line);
    } else if (keyword == "g" || keyword == "o") {
      const std::size_t start = line.find_first_not_of(kBlank);
      const std::size_t end = line.find_last_not_of(kBlank);
      group_name_ = start == std::string_view::npos ? "" : std::string(line.substr(start, end - start + 1));
      group_ = -1;
      any_group_ = true;
    } else if (keyword == "stitch") {
      read_stitch(line);
    }
  }

  void read_face(std::string_view rest) {
    corners_.clear();
    corner_uvs_.clear();
    for (std::string_view word = next_word(rest); !word.empty(); word = next_word(rest)) {
      const std::size_t slash = word.find('/');
      corners_.push_back(resolve(word.substr(0, slash), mesh_.vertices.size(), "vertex"));
      if (slash == std::string_view::npos) continue;
      const std::string_view after = word.substr(slash + 1);
      const std::string_view uv = after.substr(0, after.find('/'));
      if (!uv.empty()) corner_uvs_.push_back(resolve(uv, uvs_.size(), "texture coordinate"));
    }
    if (corners_.size() < 3) fail("a face has fewer than three corners");
    const bool has_uv = corner_uvs_.size() == corners_.size();
    every_face_has_uv_ = every_face_has_uv_ && has_uv;
    if (mesh_.triangles.size() + corners_.size() - 2 > kMaxMeshTriangles) fail("more than four million triangles");
    for (std::size_t k = 1; k + 1 < corners_.size(); ++k) {
      const Triangle triangle = {corners_[0], corners_[k], corners_[k + 1]};
      if (triangle[0] == triangle[1] || triangle[1] == triangle[2] || triangle[2] == triangle[0]) {
        fail("a face names a vertex twice");
      }
      mesh_.triangles.push_back(triangle);
      mesh_.triangle_group.push_back(current_group());
      if (!every_face_has_uv_) continue;
      const auto uv = [&](std::size_t i) -> const Vec2& { return uvs_[static_cast<std::size_t>(corner_uvs_[i])]; };
      mesh_.corner_uv.push_back({uv(0), uv(k), uv(k + 1)});
    }
  }

  int current_group() {
    if (group_ >= 0) return group_;
    const auto [entry, added] = group_index_.try_emplace(group_name_, static_cast<int>(mesh_.group_names.size()));
    if (added) mesh_.group_names.push_back(group_name_);
    return group_ = entry->second;
  }

  void read_stitch(std::string_view rest) {
    std::array<int, 3> index{};
    for (int& i : index) {
      const std::optional<long> value = integer(next_word(rest));
      if (!value || *value < 0 || *value >= static_cast<long>(kMaxMeshVertices)) fail("a stitch needs three vertices");
      i = static_cast<int>(*value);
    }
    const double t = number(rest, "stitch");
    if (t < 0 || t > 1) fail("a stitch's place on its edge is not between 0 and 1");
    mesh_.stitches.push_back({index[0], index[1], index[2], t});
    stitch_lines_.push_back(line_);
  }

  void check_stitches() {
    const int count = static_cast<int>(mesh_.vertices.size());
    for (std::size_t s = 0; s < mesh_.stitches.size(); ++s) {
      const TriangleMesh::Stitch& stitch = mesh_.stitches[s];
      if (stitch.vertex < count && stitch.from < count && stitch.to < count) continue;
      line_ = stitch_lines_[s];
      fail("a stitch names a vertex that is not there");
    }
  }

  const std::string& pointer_;
  TriangleMesh mesh_;
  std::vector<Vec2> uvs_;
  std::vector<int> corners_, corner_uvs_;
  std::vector<long> stitch_lines_;
  std::map<std::string, int> group_index_;
  std::string group_name_;
  int group_ = -1;
  long line_ = 0;
  bool every_face_has_uv_ = true, any_group_ = false;
};

void append(std::string& text, double value) {
  std::array<char, 32> digits;
  // Every bit: a stiff cloth's forces hang on the tenth digit (toile check).
  const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr;
  text += ' ';
  text.append(digits.data(), end);
}

}  // namespace

TriangleMesh read_obj(std::string_view text, const std::string& pointer) { return ObjReader(pointer).read(text); }

std::string write_obj(const TriangleMesh& mesh) {
  std::string text;
  text.reserve(48 * mesh.vertices.size() + 96 * mesh.triangles.size());
  for (const Vec3& vertex : mesh.vertices) {
    text += 'v';
    for (int axis = 0; axis < 3; ++axis) append(text, vertex[axis]);
    text += '\n';
  }
  std::vector<std::array<int, 3>> uv_index(mesh.corner_uv.size());
  std::map<std::tuple<int, double, double>, int> written;  // one vt per vertex and place, not per corner
  for (std::size_t t = 0; t < mesh.corner_uv.size(); ++t) {
    for (std::size_t i = 0; i < 3; ++i) {
      const Vec2& uv = mesh.corner_uv[t][i];
      const auto [entry, added] =
          written.try_emplace({mesh.triangles[t][i], uv.x(), uv.y()}, static_cast<int>(written.size()) + 1);
      uv_index[t][i] = entry->second;
      if (!added) continue;
      text += "vt";
      append(text, uv.x());
      append(text, uv.y());
      text += '\n';
    }
  }
  int group = -1;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (!mesh.triangle_group.empty() && mesh.triangle_group[t] != group) {
      group = mesh.triangle_group[t];
      text += "g " + mesh.group_names[static_cast<std::size_t>(group)] + '\n';
    }
    text += 'f';
    for (std::size_t i = 0; i < 3; ++i) {
      text += ' ' + std::to_string(mesh.triangles[t][i] + 1);
      if (!uv_index.empty()) text += '/' + std::to_string(uv_index[t][i]);
    }
    text += '\n';
  }
  for (const TriangleMesh::Stitch& stitch : mesh.stitches) {
    text +=
        "stitch " + std::to_string(stitch.vertex) + ' ' + std::to_string(stitch.from) + ' ' + std::to_string(stitch.to);
    append(text, stitch.t);
    text += '\n';
  }
  return text;
}

}  // namespace toile
