// The one C++ file: half-edge analysis by OpenMesh, behind the C interface of openmesh.h.

#include "scene/openmesh.h"

#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
#include <OpenMesh/Core/System/omstream.hh>

#include <algorithm>
#include <climits>
#include <cmath>
#include <new>
#include <vector>

namespace {

// OpenMesh talks to stderr about every face it refuses.  Its streams are global; they are put back
// as they were, flushed, for a disabled stream drops what it holds.
class silence {
  public:
    silence()
    {
        for (int i = 0; i < 3; i++) {
            enabled_[i] = stream(i).is_enabled();
            stream(i).disable();
        }
    }
    ~silence()
    {
        for (int i = 0; i < 3; i++) {
            stream(i).flush();
            if (enabled_[i])
                stream(i).enable();
        }
    }
    silence(const silence &) = delete;
    silence &operator=(const silence &) = delete;

  private:
    static OpenMesh::mostream &stream(int i)
    {
        return i == 0 ? omlog() : i == 1 ? omout() : omerr();
    }
    bool enabled_[3] = {};
};

// Only connectivity is asked for; positions stay in the caller's doubles.
class analysis {
  public:
    analysis(const struct vec3 *points, size_t point_count, size_t face_count,
             openmesh_normal *face_normal)
        : points_(points), face_normal_(face_normal), used_(point_count)
    {
        mesh_.reserve(point_count, point_count + face_count, face_count); // Euler: e = v + f - 2
        edges_.reserve(3 * face_count);
        for (size_t i = 0; i < point_count; i++)
            mesh_.new_vertex();
        if (point_count)
            set_origin(point_count);
    }

    void add(const struct triangle_corners &face)
    {
        const uint32_t *v = face.at;
        for (int i = 0; i < 3; i++)
            used_[v[i]] = true;
        bool collapsed = v[0] == v[1] || v[1] == v[2] || v[2] == v[0];
        struct vec3 unused;
        bool flat =
            collapsed || !face_normal_(points_[v[0]], points_[v[1]], points_[v[2]], &unused);
        if (flat && degenerate_++ == 0)
            first_degenerate_ = face_;
        face_++;
        if (collapsed)
            return;
        // A face of zero area still closes the seam between its neighbours.
        for (int i = 0; i < 3; i++)
            edges_.push_back(edge(v[i], v[(i + 1) % 3]));
        if (!flat)
            connect(v);
    }

    struct mesh_report report()
    {
        struct mesh_report r = {};
        r.boundary_edges = boundary_edges(r.first_boundary);
        r.non_manifold_faces = non_manifold_;
        r.degenerate_faces = degenerate_;
        r.unused_vertices = static_cast<size_t>(std::count(used_.begin(), used_.end(), false));
        r.volume = volume_;
        r.first_non_manifold = first_non_manifold_;
        r.first_degenerate = first_degenerate_;
        r.first_unused =
            static_cast<size_t>(std::find(used_.begin(), used_.end(), false) - used_.begin());
        return r;
    }

  private:
    using half_edges = OpenMesh::TriMesh_ArrayKernelT<>;
    using vertex = half_edges::VertexHandle;

    // Lower vertex first.
    static uint64_t edge(uint64_t a, uint64_t b)
    {
        return a < b ? a << 32 | b : b << 32 | a;
    }

    static vertex handle(uint32_t i)
    {
        return vertex(static_cast<int>(i));
    }

    // The middle of the bounding box: a mesh far from the world's origin would cancel there.
    void set_origin(size_t point_count)
    {
        struct vec3 lo = points_[0], hi = points_[0];
        for (size_t i = 1; i < point_count; i++) {
            const struct vec3 &p = points_[i];
            lo = vec3(std::fmin(lo.x, p.x), std::fmin(lo.y, p.y), std::fmin(lo.z, p.z));
            hi = vec3(std::fmax(hi.x, p.x), std::fmax(hi.y, p.y), std::fmax(hi.z, p.z));
        }
        origin_ = vec3_add(vec3_scale(lo, 0.5), vec3_scale(hi, 0.5));
    }

    void connect(const uint32_t *v)
    {
        struct vec3 a = vec3_sub(points_[v[0]], origin_);
        struct vec3 b = vec3_sub(points_[v[1]], origin_);
        struct vec3 c = vec3_sub(points_[v[2]], origin_);
        volume_ += vec3_dot(a, vec3_cross(b, c)) / 6; // a tetrahedron to the origin: Gauss
        if (mesh_.add_face(handle(v[0]), handle(v[1]), handle(v[2])).is_valid())
            return;
        // As OpenMesh's own importer does it: vertices of its own, hence neighbours with none.
        vertex own[3] = {mesh_.new_vertex(), mesh_.new_vertex(), mesh_.new_vertex()};
        mesh_.add_face(own[0], own[1], own[2]);
        if (non_manifold_++ == 0)
            first_non_manifold_ = face_ - 1;
    }

    // Counted on the file's vertices: the half-edge structure has a boundary wherever it had to
    // duplicate some.
    size_t boundary_edges(uint32_t first[2])
    {
        std::sort(edges_.begin(), edges_.end());
        size_t lonely = 0, n = edges_.size();
        for (size_t i = 0, next = 0; i < n; i = next) {
            while (next < n && edges_[next] == edges_[i])
                next++;
            if (next - i == 1 && lonely++ == 0) {
                first[0] = static_cast<uint32_t>(edges_[i] >> 32);
                first[1] = static_cast<uint32_t>(edges_[i]);
            }
        }
        return lonely;
    }

    half_edges mesh_;
    const struct vec3 *points_;
    openmesh_normal *face_normal_;
    struct vec3 origin_ = vec3_all(0);
    std::vector<bool> used_;
    std::vector<uint64_t> edges_;
    size_t non_manifold_ = 0, degenerate_ = 0;
    size_t face_ = 0, first_non_manifold_ = 0, first_degenerate_ = 0;
    double volume_ = 0;
};

} // namespace

extern "C" int openmesh_module_analyse(const struct vec3 *points, size_t point_count,
                                       const struct triangle_corners *faces, size_t face_count,
                                       openmesh_normal *face_normal, struct mesh_report *report)
{
    // Handles are ints: six half-edges a face at most, three vertices a duplicated one.
    if (face_count > INT_MAX / 6 || point_count > INT_MAX - 3 * face_count)
        return OPENMESH_TOO_LARGE;
    try {
        silence quiet;
        analysis a(points, point_count, face_count, face_normal);
        for (size_t i = 0; i < face_count; i++)
            a.add(faces[i]);
        *report = a.report();
        return OPENMESH_DONE;
    } catch (const std::bad_alloc &) {
        return OPENMESH_NO_MEMORY;
    } catch (...) {
        return OPENMESH_FAILED;
    }
}
