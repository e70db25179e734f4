// CGAL's Surface_mesh and OpenMesh in C++, used as their manuals have it, in float32: queries and operations in a loop,
// and the six algorithms of Sieger & Botsch (2011, section 4) as in hem/algorithms/sieger_botsch.py, written once over
// what the two libraries have in common.
// Arguments: the library, a file of points (float32, 3 each), one of triangles (int32, 3 each), a number of vertices to
// ask at (0 for all), the rounds of queries, and those of building, operations and algorithms.
// Prints a JSON object: "times": subject -> seconds each round, per element or as a whole, "all ..." of all elements in
// order; "answers": query -> what was asked and answered of a few elements; "results": algorithm -> see `result`;
// "operated": operation, "" for building -> how many were done, and the vertices, edges and faces there then are;
// "faces", "bytes", and "collapsed", whether the first edge may be, with the faces "left".
#include <CGAL/Simple_cartesian.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/boost/graph/Euler_operations.h>
#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
#include <algorithm>
#include <chrono>
#include <ctime>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <random>
#include <string>
#include <unistd.h>
#include <vector>

using P = OpenMesh::Vec3f;
std::vector<P> points;
std::vector<int> corners;
std::vector<P> vertex_normals;  // the last that were found
const int asked = 20000, checked = 3;

struct Cgal {
  using Point = CGAL::Simple_cartesian<float>::Point_3;
  using M = CGAL::Surface_mesh<Point>;
  using V = M::Vertex_index;
  using F = M::Face_index;
  using E = M::Edge_index;
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
  template <class Visit> void edges_at(V v, Visit visit) { for (auto h : m.halfedges_around_target(m.halfedge(v))) visit(m.edge(h)); }
  template <class Visit> void edges_of(F f, Visit visit) { for (auto h : m.halfedges_around_face(m.halfedge(f))) visit(m.edge(h)); }
  template <class Visit> void beside(F f, Visit visit) { for (auto h : m.halfedges_around_face(m.halfedge(f))) if (auto g = m.face(m.opposite(h)); g != M::null_face()) visit(g); }
  template <class Visit> void ends(E e, Visit visit) { visit(m.vertex(e, 0)); visit(m.vertex(e, 1)); }
  template <class Visit> void sides(E e, Visit visit) { for (int i : {0, 1}) if (auto f = m.face(m.halfedge(e, i)); f != M::null_face()) visit(f); }
  void split(F f, P p) { move(m.target(CGAL::Euler::add_center_vertex(m.halfedge(f), m)), p); }
  void split(E e, P p) {
    auto h = m.halfedge(e), before = CGAL::Euler::split_edge(h, m), g = m.opposite(h);
    move(m.target(before), p);
    if (!m.is_border(h)) CGAL::Euler::split_face(before, m.next(h), m);
    if (!m.is_border(g)) CGAL::Euler::split_face(g, m.next(m.opposite(before)), m);
  }
  void flip(E e) { if (!m.is_border(e)) CGAL::Euler::flip_edge(m.halfedge(e), m); }
  bool collapse(E e) { bool may = !m.is_removed(e) && CGAL::Euler::does_satisfy_link_condition(e, m); if (may) CGAL::Euler::collapse_edge(e, m); return may; }
  E edge_at(V v) { return m.edge(m.halfedge(v)); }
  void compact() { m.collect_garbage(); }
};

struct Open {
  using M = OpenMesh::TriMesh_ArrayKernelT<>;
  using V = M::VertexHandle;
  using F = M::FaceHandle;
  using E = M::EdgeHandle;
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
  template <class Visit> void edges_at(V v, Visit visit) { for (E e : m.ve_range(v)) visit(e); }
  template <class Visit> void edges_of(F f, Visit visit) { for (E e : m.fe_range(f)) visit(e); }
  template <class Visit> void beside(F f, Visit visit) { for (auto g : m.ff_range(f)) visit(g); }
  template <class Visit> void ends(E e, Visit visit) { for (int i : {0, 1}) visit(m.to_vertex_handle(m.halfedge_handle(e, i))); }
  template <class Visit> void sides(E e, Visit visit) { for (int i : {0, 1}) if (auto f = m.face_handle(m.halfedge_handle(e, i)); f.is_valid()) visit(f); }
  void split(F f, P p) { m.split(f, m.add_vertex(p)); }
  void split(E e, P p) { m.split(e, m.add_vertex(p)); }
  void flip(E e) { if (!m.is_boundary(e)) m.flip(e); }
  bool collapse(E e) { return collapse(m.halfedge_handle(e, 0)); }
  bool collapse(M::HalfedgeHandle h) { bool may = !m.status(h).deleted() && m.is_collapse_ok(h); if (may) m.collapse(h); return may; }
  M::HalfedgeHandle edge_at(V v) { return m.halfedge_handle(v); }
  void compact() { m.garbage_collection(); }
};

int number(Cgal::V v) { return int(v); }
int number(Cgal::E e) { return int(e); }
int number(Cgal::F f) { return int(f); }
int number(OpenMesh::BaseHandle h) { return h.idx(); }

double now() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

// Of the processor, which other programs on the machine make the least difference to.
double cpu() {
  timespec time;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);  // std::clock has microseconds, too few for a small mesh
  return time.tv_sec + 1e-9 * time.tv_nsec;
}

// Bytes of the process that it shares with no other.
size_t own_bytes() {
  size_t size, resident, shared;
  std::ifstream("/proc/self/statm") >> size >> resident >> shared;
  return (resident - shared) * sysconf(_SC_PAGESIZE);
}

bool first = true;
void name(const std::string &text) {
  std::printf("%s\"%s\": ", first ? "" : ", ", text.c_str());
  first = false;
}
void list(const char *format, const std::vector<double> &values) {
  std::printf("[");
  for (size_t i = 0; i < values.size(); i++) std::printf("%s", i ? ", " : ""), std::printf(format, values[i]);
  std::printf("]");
}

template <class L> struct Measured {
  using V = typename L::V;
  using F = typename L::F;
  using E = typename L::E;

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
    vertex_normals.swap(found);
    return vertex_normals.size();
  }
  static long smoothing(L &s) {
    move(s, averages(s, [](int) { return 1.f; }));
    return s.vertices();
  }
  static long subdivision(L &s) {
    size_t edges = s.edges();
    auto places = averages(s, [](int n) { return (4 - 2 * std::cos(2 * float(M_PI) / n)) / 9; });
    split_all(s);
    for (size_t i = 0; i < edges; i++) s.flip(E(i));
    move(s, places);
    return s.faces();
  }
  static long collapse(L &s) {
    size_t old = s.vertices();
    split_all(s);
    for (size_t i = old, end = s.vertices(); i < end; i++) s.collapse(s.edge_at(V(i)));
    s.compact();
    return s.faces();
  }

  // What an algorithm returned, and what any order of elements gives of the mesh after it: the numbers of vertices and
  // faces, sums of coordinates and of squared lengths of edges, and the sums of normals, and of them times positions.
  static std::vector<double> result(L &s, long returned) {
    double places[3] = {}, normals[3] = {}, product = 0, lengths = 0;
    for (size_t i = 0; i < s.vertices(); i++) {
      for (int j = 0; j < 3; j++) {
        double at = s.at(V(i))[j], normal = i < vertex_normals.size() ? vertex_normals[i][j] : 0;
        places[j] += at, normals[j] += normal, product += at * normal;
      }
    }
    for (size_t i = 0; i < s.edges(); i++) {
      std::vector<P> at;
      s.ends(E(i), [&](V v) { at.push_back(s.at(v)); });
      lengths += (at[1] - at[0]).sqrnorm();
    }
    vertex_normals.clear();
    return {double(returned), double(s.vertices()), double(s.faces()), places[0], places[1], places[2], lengths,
            normals[0], normals[1], normals[2], product};
  }

  // Edges as their two vertices.
  static void key(L &s, E e, std::vector<double> &into) { s.ends(e, [&](V v) { into.push_back(number(v)); }); }
  template <class H> static void key(L &, H h, std::vector<double> &into) { into.push_back(number(h)); }

  // Some elements in random order: of those with a corner below `few`, or of all.
  template <class H, class Corners> static std::vector<int> some(size_t elements, int few, Corners corners) {
    std::vector<int> chosen;
    for (size_t i = 0; i < elements; i++) {
      bool at = !few;
      corners(H(i), [&](V v) { at = at || number(v) < few; });
      if (at) chosen.push_back(i);
    }
    std::shuffle(chosen.begin(), chosen.end(), std::mt19937(7));
    if (chosen.size() > asked) chosen.resize(asked);
    return chosen;
  }

  // Ask some elements in random order, round by round; answers are summed, as a caller would use them.
  template <class H, class Ask> static void query(L &s, const char *title, const std::vector<int> &chosen, int rounds, bool check, Ask ask) {
    name(title);
    if (check) {
      std::printf("[");
      for (int i = 0; i < checked && i < int(chosen.size()); i++) {
        std::vector<double> of, found;
        key(s, H(chosen[i]), of);
        ask(H(chosen[i]), [&](auto h) { key(s, h, found); });
        std::printf(i ? ", [" : "[");
        list("%.0f", of);
        std::printf(", ");
        list("%.0f", found);
        std::printf("]");
      }
      std::printf("]");
      return;
    }
    std::vector<double> seconds;
    for (int round = -1; round < rounds; round++) {
      long sum = 0;
      double begin = now();
      for (int i : chosen) ask(H(i), [&](auto h) { sum += number(h); });
      if (round >= 0) seconds.push_back((now() - begin) / chosen.size() + (sum == -1));
    }
    list("%.9g", seconds);
  }

  // All queries: answers to check, or times. Of the vertices below `few` and what is at them, or of all.
  static void queries(L &s, int few, int rounds, bool check) {
    auto vertices = some<V>(s.vertices(), few, [](V v, auto visit) { visit(v); });
    auto edges = some<E>(s.edges(), few, [&](E e, auto visit) { s.ends(e, visit); });
    auto faces = some<F>(s.faces(), few, [&](F f, auto visit) { s.corners_of(f, visit); });
    first = true;
    query<V>(s, "vertex_vertices", vertices, rounds, check, [&](V v, auto visit) { s.around(v, visit); });
    query<V>(s, "vertex_edges", vertices, rounds, check, [&](V v, auto visit) { s.edges_at(v, visit); });
    query<V>(s, "vertex_faces", vertices, rounds, check, [&](V v, auto visit) { s.faces_at(v, visit); });
    query<E>(s, "edge_vertices", edges, rounds, check, [&](E e, auto visit) { s.ends(e, visit); });
    query<E>(s, "edge_faces", edges, rounds, check, [&](E e, auto visit) { s.sides(e, visit); });
    query<F>(s, "face_vertices", faces, rounds, check, [&](F f, auto visit) { s.corners_of(f, visit); });
    query<F>(s, "face_edges", faces, rounds, check, [&](F f, auto visit) { s.edges_of(f, visit); });
    query<F>(s, "face_faces", faces, rounds, check, [&](F f, auto visit) { s.beside(f, visit); });
  }

  // Ask all elements in order, and give what they answer, and where each begins, in new arrays of the right size.
  template <class H, class Ask> static void all(const char *title, size_t elements, int rounds, Ask ask) {
    std::vector<double> seconds;
    size_t answers = 0;
    for (int round = -1; round < rounds; round++) {
      double begin = cpu();
      std::vector<int> found, begins;
      found.reserve(answers);
      begins.reserve(elements);
      for (size_t i = 0; i < elements; i++) {
        begins.push_back(found.size());
        ask(H(i), [&](auto h) { found.push_back(number(h)); });
      }
      if (round >= 0) seconds.push_back((cpu() - begin) / elements);
      answers = found.size();
    }
    name(title);
    list("%.9g", seconds);
  }

  using Counts = std::vector<std::pair<std::string, std::vector<double>>>;
  static void count(Counts &into, const char *title, L &s, long done) {
    s.compact();
    into.emplace_back(title, std::vector<double>{double(done), double(s.vertices()), double(s.edges()), double(s.faces())});
  }

  // Operate on some elements in random order, of a new mesh every round; those that are refused do not count.
  template <class Operate> static void operation(Counts &counts, const char *title, size_t elements, int rounds, Operate operate) {
    auto chosen = some<F>(elements, 0, [](F, auto) {});
    std::vector<double> seconds;
    for (int round = -1; round < rounds; round++) {
      L fresh = build();
      fresh.reserve(fresh.vertices() + asked, fresh.edges() + 3 * asked, fresh.faces() + 2 * asked);
      long done = 0;
      double begin = cpu();
      for (int i : chosen) done += operate(fresh, i);
      if (round >= 0) seconds.push_back((cpu() - begin) / done);
      if (round + 1 == rounds) count(counts, title, fresh, done);
    }
    name(title);
    list("%.9g", seconds);
  }

  static void run(int few, int rounds, int whole) {
    size_t before = own_bytes();
    L s = build();
    size_t bytes = own_bytes() - before, faces = s.faces();
    std::printf("{\"bytes\": %zu, \"faces\": %zu, \"answers\": {", bytes, faces);
    if (rounds) queries(s, few, rounds, true);
    std::printf("}, \"times\": {");
    if (rounds) queries(s, few, rounds, false);
    struct { const char *title; long (*call)(L &); } six[] = {{"build", nullptr}, {"circulator", circulator}, {"barycenter", barycenter}, {"normals", normals}, {"smoothing", smoothing}, {"subdivision", subdivision}, {"collapse", collapse}};
    std::vector<std::pair<const char *, std::vector<double>>> results;
    for (auto &it : six) {
      if (!whole) break;
      std::vector<double> seconds;
      for (int round = -1; round < whole; round++) {
        double begin = cpu();
        L fresh = build();
        long returned = 0;
        if (it.call) {
          begin = cpu();
          if (!(returned = it.call(fresh))) std::exit(1);
        }
        if (round >= 0) seconds.push_back(cpu() - begin);
        if (round + 1 == whole) results.emplace_back(it.title, result(fresh, returned));
      }
      name(it.title);
      list("%.9g", seconds);
    }
    Counts counts;
    if (whole) {
      P p = points[0];
      count(counts, "", s, 0);
      operation(counts, "split_face", s.faces(), whole, [&](L &m, int i) { m.split(F(i), p); return true; });
      operation(counts, "split_edge", s.edges(), whole, [&](L &m, int i) { m.split(E(i), p); return true; });
      operation(counts, "collapse_edge", s.edges(), whole, [](L &m, int i) { return m.collapse(E(i)); });
      all<V>("all vertex_faces", s.vertices(), whole, [&](V v, auto visit) { s.faces_at(v, visit); });
      all<F>("all face_faces", s.faces(), whole, [&](F f, auto visit) { s.beside(f, visit); });
    }
    bool collapsed = !rounds && s.edges() && s.collapse(E(0));
    s.compact();
    std::printf("}, \"results\": {");
    first = true;
    for (auto &it : results) name(it.first), list("%.9g", it.second);
    std::printf("}, \"operated\": {");
    first = true;
    for (auto &it : counts) name(it.first), list("%.9g", it.second);
    std::printf("}, \"collapsed\": %s, \"left\": %zu}\n", collapsed ? "true" : "false", s.faces());
  }
};

template <class T> void load(const char *name, std::vector<T> &into) {
  std::ifstream file(name, std::ios::binary | std::ios::ate);
  into.resize(file.tellg() / sizeof(T));
  file.seekg(0);
  file.read((char *)into.data(), into.size() * sizeof(T));
}

int main(int, char **arguments) {
  load(arguments[2], points);
  load(arguments[3], corners);
  auto run = std::string(arguments[1]) == "CGAL" ? Measured<Cgal>::run : Measured<Open>::run;
  run(std::atoi(arguments[4]), std::atoi(arguments[5]), std::atoi(arguments[6]));
}
