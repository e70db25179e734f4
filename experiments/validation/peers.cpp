// The six algorithms of Sieger & Botsch (2011, section 4) on CGAL's Surface_mesh and on OpenMesh: the same as in
// hem/algorithms/sieger_botsch.py, in float32, written once over what the two libraries have in common.
// Arguments: a file of points (float32, 3 each), one of triangles (int32, 3 each), and the rounds. Prints a JSON object:
// library -> algorithm -> the least CPU seconds of one thread.
#include <CGAL/Simple_cartesian.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/boost/graph/Euler_operations.h>
#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

using P = OpenMesh::Vec3f;
std::vector<P> points;
std::vector<int> corners;

struct Cgal {
  using Point = CGAL::Simple_cartesian<float>::Point_3;
  using M = CGAL::Surface_mesh<Point>;
  using V = M::Vertex_index;
  using F = M::Face_index;
  M m;
  void reserve(size_t nv, size_t ne, size_t nf) { m.reserve(nv, ne, nf); }
  V add(P p) { return m.add_vertex(Point(p[0], p[1], p[2])); }
  void add(V a, V b, V c) { m.add_face(a, b, c); }
  size_t vertices() { return m.number_of_vertices(); }
  size_t edges() { return m.number_of_edges(); }
  size_t faces() { return m.number_of_faces(); }
  P at(V v) { const Point &p = m.point(v); return P(p.x(), p.y(), p.z()); }
  void move(V v, P p) { m.point(v) = Point(p[0], p[1], p[2]); }
  bool on_border(V v) { return m.is_border(v); }
  template <class Visit> void around(V v, Visit visit) { for (auto w : m.vertices_around_target(m.halfedge(v))) visit(w); }
  template <class Visit> void faces_at(V v, Visit visit) { for (auto f : m.faces_around_target(m.halfedge(v))) if (f != M::null_face()) visit(f); }
  template <class Visit> void corners_of(F f, Visit visit) { for (auto v : m.vertices_around_face(m.halfedge(f))) visit(v); }
  void split(F f, P p) { move(m.target(CGAL::Euler::add_center_vertex(m.halfedge(f), m)), p); }
  void flip(int i) { M::Edge_index e(i); if (!m.is_border(e)) CGAL::Euler::flip_edge(m.halfedge(e), m); }
  void collapse(V v) { auto e = m.edge(m.halfedge(v)); if (CGAL::Euler::does_satisfy_link_condition(e, m)) CGAL::Euler::collapse_edge(e, m); }
  void compact() { m.collect_garbage(); }
};

struct Open {
  using M = OpenMesh::TriMesh_ArrayKernelT<>;
  using V = M::VertexHandle;
  using F = M::FaceHandle;
  M m;
  Open() { m.request_vertex_status(); m.request_edge_status(); m.request_halfedge_status(); m.request_face_status(); }
  void reserve(size_t nv, size_t ne, size_t nf) { m.reserve(nv, ne, nf); }
  V add(P p) { return m.add_vertex(p); }
  void add(V a, V b, V c) { m.add_face(a, b, c); }
  size_t vertices() { return m.n_vertices(); }
  size_t edges() { return m.n_edges(); }
  size_t faces() { return m.n_faces(); }
  P at(V v) { return m.point(v); }
  void move(V v, P p) { m.set_point(v, p); }
  bool on_border(V v) { return m.is_boundary(v); }
  template <class Visit> void around(V v, Visit visit) { for (auto w : m.vv_range(v)) visit(w); }
  template <class Visit> void faces_at(V v, Visit visit) { for (auto f : m.vf_range(v)) visit(f); }
  template <class Visit> void corners_of(F f, Visit visit) { for (auto v : m.fv_range(f)) visit(v); }
  void split(F f, P p) { m.split(f, m.add_vertex(p)); }
  void flip(int i) { M::EdgeHandle e(i); if (!m.is_boundary(e)) m.flip(e); }
  void collapse(V v) { auto h = m.halfedge_handle(v); if (m.is_collapse_ok(h)) m.collapse(h); }
  void compact() { m.garbage_collection(); }
};

template <class L> struct Six {
  using V = typename L::V;
  using F = typename L::F;

  static L build() {
    L s;
    s.reserve(points.size(), corners.size() / 2, corners.size() / 3);
    for (P p : points) s.add(p);
    for (size_t i = 0; i < corners.size(); i += 3) s.add(V(corners[i]), V(corners[i + 1]), V(corners[i + 2]));
    return s;
  }
  static P middle(L &s, F f) {
    P sum(0, 0, 0);
    s.corners_of(f, [&](V v) { sum += s.at(v); });
    return sum / 3.f;
  }
  template <class Part> static std::vector<P> averages(L &s, Part part) {
    std::vector<P> found(s.vertices());
    for (size_t i = 0; i < found.size(); i++) {
      V v(i);
      P sum(0, 0, 0);
      int n = 0;
      if (!s.on_border(v)) s.around(v, [&](V w) { sum += s.at(w); n++; });
      found[i] = n ? s.at(v) + (sum / float(n) - s.at(v)) * part(n) : s.at(v);
    }
    return found;
  }
  static void move(L &s, const std::vector<P> &places) {
    for (size_t i = 0; i < places.size(); i++) s.move(V(i), places[i]);
  }
  static void split_all(L &s) {
    size_t nv = s.vertices(), ne = s.edges(), nf = s.faces();
    s.reserve(nv + nf, ne + 3 * nf, 3 * nf);
    for (size_t i = 0; i < nf; i++) s.split(F(i), middle(s, F(i)));
  }

  static long circulator(L &s) {
    long count = 0;
    for (size_t i = 0; i < s.vertices(); i++) s.around(V(i), [&](V w) { count += w != V(i); });
    for (size_t i = 0; i < s.faces(); i++) s.corners_of(F(i), [&](V v) { count += v.idx() >= 0; });
    return count;
  }
  static long barycenter(L &s) {
    P sum(0, 0, 0);
    for (size_t i = 0; i < s.faces(); i++) s.corners_of(F(i), [&](V v) { sum += s.at(v); });
    sum /= 3.f * s.faces();
    for (size_t i = 0; i < s.vertices(); i++) s.move(V(i), s.at(V(i)) - sum);
    return s.faces();
  }
  static long normals(L &s) {
    std::vector<P> of_faces(s.faces()), found(s.vertices());
    for (size_t i = 0; i < of_faces.size(); i++) {
      P at[3];
      int n = 0;
      s.corners_of(F(i), [&](V v) { at[n++] = s.at(v); });
      of_faces[i] = (at[1] - at[0]) % (at[2] - at[0]);
    }
    for (size_t i = 0; i < found.size(); i++) {
      P sum(0, 0, 0);
      s.faces_at(V(i), [&](F f) { sum += of_faces[f.idx()]; });
      found[i] = sum / sum.norm();
    }
    return found.back() == found.back() ? found.size() : 1;
  }
  static long smoothing(L &s) {
    move(s, averages(s, [](int) { return 1.f; }));
    return s.vertices();
  }
  static long subdivision(L &s) {
    size_t edges = s.edges();
    auto places = averages(s, [](int n) { return (4 - 2 * std::cos(2 * float(M_PI) / n)) / 9; });
    split_all(s);
    for (size_t i = 0; i < edges; i++) s.flip(i);
    move(s, places);
    return s.faces();
  }
  static long collapse(L &s) {
    size_t old = s.vertices();
    split_all(s);
    for (size_t i = old, end = s.vertices(); i < end; i++) s.collapse(V(i));
    s.compact();
    return s.faces();
  }

  static void run(const char *library, int rounds) {
    struct { const char *name; long (*call)(L &); } six[] = {{"circulator", circulator}, {"barycenter", barycenter}, {"normals", normals}, {"smoothing", smoothing}, {"subdivision", subdivision}, {"collapse", collapse}};
    std::printf("\"%s\": {", library);
    for (auto &it : six) {
      double best = 1e9;
      for (int i = 0; i < rounds; i++) {
        L s = build();
        clock_t begin = clock();
        if (!it.call(s)) std::exit(1);
        best = std::min(best, double(clock() - begin) / CLOCKS_PER_SEC);
      }
      std::printf("%s\"%s\": %.6f", it.call == circulator ? "" : ", ", it.name, best);
    }
    std::printf("}");
  }
};

template <class T> void load(const char *name, std::vector<T> &into) {
  std::ifstream file(name, std::ios::binary | std::ios::ate);
  into.resize(file.tellg() / sizeof(T));
  file.seekg(0);
  file.read((char *)into.data(), into.size() * sizeof(T));
}

int main(int, char **arguments) {
  load(arguments[1], points);
  load(arguments[2], corners);
  int rounds = std::atoi(arguments[3]);
  std::printf("{");
  Six<Cgal>::run("CGAL", rounds);
  std::printf(", ");
  Six<Open>::run("OpenMesh", rounds);
  std::printf("}\n");
}
