// The only file that knows Open CASCADE.
#include "io/cad_shape.h"

#include <hex/base/error.h>

#ifndef HEXSPLINE_WITH_OCCT

namespace hex::io {

CadTriangles tessellate_cad(CadFormat, const std::string&, std::string_view, const CadOptions&) {
    throw Error(ErrorKind::unsupported, "this build reads no CAD files", {},
                "build with -DHEXSPLINE_WITH_OCCT=ON, or give triangles");
}

}  // namespace hex::io

#else

#include <BRepAdaptor_Surface.hxx>
#include <BRepBndLib.hxx>
#include <BRepBuilderAPI_Sewing.hxx>
#include <BRepLProp_SLProps.hxx>
#include <BRepMesh_IncrementalMesh.hxx>
#include <BRepTools.hxx>
#include <BRep_Builder.hxx>
#include <BRep_Tool.hxx>
#include <Bnd_Box.hxx>
#include <Geom2d_Curve.hxx>
#include <IGESControl_Reader.hxx>
#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <Poly_PolygonOnTriangulation.hxx>
#include <Poly_Triangulation.hxx>
#include <STEPControl_Reader.hxx>
#include <Standard_Failure.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Face.hxx>
#include <TopoDS_Shape.hxx>
#include <TopoDS_Vertex.hxx>

#include <algorithm>
#include <cmath>
#include <istream>
#include <limits>
#include <map>
#include <numbers>
#include <optional>
#include <streambuf>

namespace hex::io {
namespace {

constexpr auto no_point = std::numeric_limits<std::uint32_t>::max();

double radians(double degrees) {
    return degrees * std::numbers::pi / 180.0;
}

Vec3 to_vec(const gp_Pnt& p) {
    return {p.X(), p.Y(), p.Z()};
}

/// A stream over bytes that somebody else holds.
class ByteStream : private std::streambuf, public std::istream {
  public:
    explicit ByteStream(std::string_view bytes) : std::istream(static_cast<std::streambuf*>(this)) {
        char* begin = const_cast<char*>(bytes.data());
        setg(begin, begin, begin + bytes.size());
    }
};

[[noreturn]] void fail(std::string what, std::string advice = "export the model again") {
    throw Error(ErrorKind::bad_input, std::move(what), {}, std::move(advice));
}

template <class Reader>
TopoDS_Shape transferred(Reader& reader, IFSelect_ReturnStatus status, const char* format) {
    if (status != IFSelect_RetDone) fail(std::string("cannot be read as ") + format);
    reader.TransferRoots();
    TopoDS_Shape shape = reader.OneShape();
    if (shape.IsNull()) fail("holds no shape");
    return shape;
}

TopoDS_Shape read_shape(CadFormat format, const std::string& path, std::string_view bytes) {
    // Open CASCADE talks to standard output otherwise.
    Message::DefaultMessenger()->ChangePrinters().Clear();
    if (format == CadFormat::iges) {
        IGESControl_Reader reader;
        return transferred(reader, reader.ReadFile(path.c_str()), "IGES");
    }
    ByteStream stream(bytes);
    if (format == CadFormat::step) {
        STEPControl_Reader reader;
        return transferred(reader, reader.ReadStream(path.c_str(), stream), "STEP");
    }
    TopoDS_Shape shape;
    // Open CASCADE does not ask whether its reading succeeds, and loops at the end of a file that is cut off.
    stream.exceptions(std::ios::failbit | std::ios::badbit);
    try {
        BRepTools::Read(shape, stream, BRep_Builder());
    } catch (const std::ios_base::failure&) {
        fail("ends early or is damaged");
    }
    if (shape.IsNull()) fail("cannot be read as BREP");
    return shape;
}

std::vector<TopoDS_Shape> parts_of(const TopoDS_Shape& shape, TopAbs_ShapeEnum kind,
                                   TopAbs_ShapeEnum outside = TopAbs_SHAPE) {
    std::vector<TopoDS_Shape> parts;
    for (TopExp_Explorer it(shape, kind, outside); it.More(); it.Next()) parts.push_back(it.Current());
    return parts;
}

double diagonal_of(const TopoDS_Shape& shape) {
    Bnd_Box box;
    BRepBndLib::Add(shape, box);
    return box.IsVoid() ? 0.0 : std::sqrt(box.SquareExtent());
}

/// Faces that do not know each other, joined where their edges lie within a tolerance; the smallest of a few
/// that leaves no edge free, or the largest.
TopoDS_Shape sewn(const TopoDS_Shape& shape, double diagonal) {
    TopoDS_Shape result;
    for (const double share : {1e-7, 1e-6, 1e-5, 1e-4}) {
        BRepBuilderAPI_Sewing sewing(share * diagonal);
        for (const TopoDS_Shape& face : parts_of(shape, TopAbs_FACE)) sewing.Add(face);
        sewing.Perform();
        result = sewing.SewedShape();
        if (sewing.NbFreeEdges() == 0) break;
    }
    return result;
}

/// Turns the triangulations of faces into one triangle soup that shares points along edges and at vertices.
class Welder {
  public:
    explicit Welder(double sharp_angle) : sharp_cosine_(std::cos(radians(sharp_angle))) {}

    /// The faces of a solid or shell; turned outwards as a whole.
    void add(const TopoDS_Shape& body) {
        const std::size_t first = soup_.size();
        for (const TopoDS_Shape& face : parts_of(body, TopAbs_FACE)) add_face(TopoDS::Face(face));
        double volume = 0.0;
        for (std::size_t f = first; f < soup_.size(); ++f) {
            const auto t = soup_.polygon(f);
            volume += soup_.points[t[0]].dot(soup_.points[t[1]].cross(soup_.points[t[2]]));
        }
        if (volume >= 0.0) return;
        for (std::size_t f = first; f < soup_.size(); ++f)
            std::swap(soup_.corners[soup_.offsets[f] + 1], soup_.corners[soup_.offsets[f] + 2]);
    }

    CadTriangles finish() {
        CadTriangles result;
        result.data.surface = std::move(soup_);
        std::size_t open = 0;
        for (const auto& [number, edge] : edges_) {
            if (edge.sides.size() == 1) ++open;
            add_sharp(edge, result.sharp_edges);
        }
        if (open > 0)
            result.data.diagnostics.push_back({Severity::note,
                                               "open-shell",
                                               std::to_string(open) + " edges have a face on one side only",
                                               {},
                                               {}});
        if (!without_area_.empty())
            result.data.warn(
                "face-without-area",
                std::to_string(without_area_.size()) + " faces got no triangles: " + list_ids(without_area_),
                "face", without_area_);
        return result;
    }

  private:
    /// One face at an edge: the outward normals along the edge, one a segment; none where it has none.
    struct Side {
        int face;
        std::vector<std::optional<Vec3>> normals;
    };
    struct Edge {
        std::vector<std::uint32_t> points;  ///< along the edge in its own direction
        std::vector<Side> sides;
    };

    std::uint32_t point(const gp_Pnt& p) {
        soup_.points.push_back(to_vec(p));
        return static_cast<std::uint32_t>(soup_.points.size() - 1);
    }

    std::uint32_t point_of(const TopoDS_Vertex& vertex) {
        const int number = shapes_.Add(vertex);
        const auto [entry, added] = vertices_.emplace(number, no_point);
        if (added) entry->second = point(BRep_Tool::Pnt(vertex));
        return entry->second;
    }

    void add_face(const TopoDS_Face& face) {
        ++face_count_;
        TopLoc_Location location;
        const Handle(Poly_Triangulation) triangles = BRep_Tool::Triangulation(face, location);
        if (triangles.IsNull() || triangles->NbTriangles() == 0) {
            without_area_.push_back(face_count_);
            return;
        }
        std::vector<std::uint32_t> points(static_cast<std::size_t>(triangles->NbNodes()), no_point);
        for (const TopoDS_Shape& edge : parts_of(face, TopAbs_EDGE))
            add_edge(TopoDS::Edge(edge), face, triangles, location, points);
        for (int i = 1; i <= triangles->NbNodes(); ++i)
            if (std::uint32_t& at = points[static_cast<std::size_t>(i - 1)]; at == no_point)
                at = point(triangles->Node(i).Transformed(location.Transformation()));
        const bool mirrored =
            (face.Orientation() == TopAbs_REVERSED) != location.Transformation().IsNegative();
        for (int i = 1; i <= triangles->NbTriangles(); ++i) {
            std::array<int, 3> node{};
            triangles->Triangle(i).Get(node[0], node[1], node[2]);
            std::array<std::uint32_t, 3> corner{};
            for (std::size_t k = 0; k < 3; ++k) corner[k] = points[static_cast<std::size_t>(node[k] - 1)];
            // At a pole, where an edge is a point, triangles may vanish.
            if (corner[0] == corner[1] || corner[1] == corner[2] || corner[2] == corner[0]) continue;
            if (mirrored) std::swap(corner[1], corner[2]);
            soup_.add_polygon(corner, face_count_);
        }
    }

    void add_edge(const TopoDS_Edge& edge, const TopoDS_Face& face,
                  const Handle(Poly_Triangulation) & triangles, const TopLoc_Location& location,
                  std::vector<std::uint32_t>& points) {
        const Handle(Poly_PolygonOnTriangulation)& polygon =
            BRep_Tool::PolygonOnTriangulation(edge, triangles, location);
        if (polygon.IsNull()) return;
        const auto at = [&](int i) -> std::uint32_t& {
            return points[static_cast<std::size_t>(polygon->Node(i) - 1)];
        };
        const TopoDS_Edge forward = TopoDS::Edge(edge.Oriented(TopAbs_FORWARD));
        const TopoDS_Vertex first = TopExp::FirstVertex(forward);
        const TopoDS_Vertex last = TopExp::LastVertex(forward);
        if (first.IsNull() || last.IsNull()) return;
        if (BRep_Tool::Degenerated(edge)) {
            for (int i = 1; i <= polygon->NbNodes(); ++i) at(i) = point_of(first);
            return;
        }
        Edge& known = edges_[shapes_.Add(edge)];
        if (known.points.empty()) {
            known.points.push_back(point_of(first));
            for (int i = 2; i < polygon->NbNodes(); ++i)
                known.points.push_back(
                    point(triangles->Node(polygon->Node(i)).Transformed(location.Transformation())));
            known.points.push_back(point_of(last));
        }
        // Open CASCADE cuts an edge once for all its faces; otherwise the surface stays open here.
        if (known.points.size() != static_cast<std::size_t>(polygon->NbNodes())) return;
        for (int i = 1; i <= polygon->NbNodes(); ++i) at(i) = known.points[static_cast<std::size_t>(i - 1)];
        known.sides.push_back({face_count_, normals_along(edge, face, polygon)});
    }

    /// Outward normals of a face in the middle of the segments of one of its edges.
    static std::vector<std::optional<Vec3>> normals_along(const TopoDS_Edge& edge, const TopoDS_Face& face,
                                                          const Handle(Poly_PolygonOnTriangulation) &
                                                              polygon) {
        std::vector<std::optional<Vec3>> normals(static_cast<std::size_t>(polygon->NbNodes() - 1));
        double first = 0.0;
        double last = 0.0;
        const Handle(Geom2d_Curve) curve = BRep_Tool::CurveOnSurface(edge, face, first, last);
        if (curve.IsNull() || !polygon->HasParameters()) return normals;
        const BRepAdaptor_Surface surface(face);
        BRepLProp_SLProps properties(surface, 1, 1e-9);
        for (int i = 1; i < polygon->NbNodes(); ++i) {
            const gp_Pnt2d uv = curve->Value(0.5 * (polygon->Parameter(i) + polygon->Parameter(i + 1)));
            properties.SetParameters(uv.X(), uv.Y());
            if (!properties.IsNormalDefined()) continue;
            const gp_Dir n = properties.Normal();
            const double sign = face.Orientation() == TopAbs_REVERSED ? -1.0 : 1.0;
            normals[static_cast<std::size_t>(i - 1)] = sign * Vec3(n.X(), n.Y(), n.Z());
        }
        return normals;
    }

    void add_sharp(const Edge& edge, std::vector<std::array<std::uint32_t, 2>>& sharp) const {
        if (edge.sides.size() != 2) return;
        for (std::size_t i = 0; i + 1 < edge.points.size(); ++i) {
            const auto& a = edge.sides[0].normals[i];
            const auto& b = edge.sides[1].normals[i];
            if (a && b && a->dot(*b) < sharp_cosine_) sharp.push_back({edge.points[i], edge.points[i + 1]});
        }
    }

    double sharp_cosine_;
    PolygonSoup soup_;
    int face_count_ = 0;
    TopTools_IndexedMapOfShape shapes_;  ///< numbers of edges and vertices, whatever their orientation
    std::map<int, std::uint32_t> vertices_;
    std::map<int, Edge> edges_;
    std::vector<std::int64_t> without_area_;
};

CadTriangles tessellate(TopoDS_Shape shape, const CadOptions& options) {
    std::vector<TopoDS_Shape> bodies = parts_of(shape, TopAbs_SOLID);
    const std::size_t solids = bodies.size();
    const double diagonal = diagonal_of(shape);
    if (parts_of(shape, TopAbs_FACE).empty()) fail("holds no faces", "export solids");
    if (!(diagonal > 0.0) || !std::isfinite(diagonal)) fail("holds a model without extent");
    const std::size_t loose = parts_of(shape, TopAbs_SHELL, TopAbs_SOLID).size() +
                              parts_of(shape, TopAbs_FACE, TopAbs_SHELL).size();
    if (solids == 0) {
        shape = sewn(shape, diagonal);
        bodies = parts_of(shape, TopAbs_SHELL);
        // A lone face is no shell.
        for (const TopoDS_Shape& face : parts_of(shape, TopAbs_FACE, TopAbs_SHELL)) bodies.push_back(face);
    }
    const double deflection = options.deflection > 0.0 ? options.deflection : 5e-4 * diagonal;
    // Not relative to the edges, and on one thread: the same triangles every time.
    BRepMesh_IncrementalMesh mesher(shape, deflection, false, radians(options.angle), false);

    Welder welder(options.sharp_angle);
    for (const TopoDS_Shape& body : bodies) welder.add(body);
    CadTriangles result = welder.finish();
    result.data.diagnostics.push_back({Severity::note, "solids", std::to_string(solids) + " solids", {}, {}});
    if (solids > 0 && loose > 0)
        result.data.warn("shells-skipped",
                         std::to_string(loose) + " shells or faces outside the solids are skipped");
    return result;
}

}  // namespace

CadTriangles tessellate_cad(CadFormat format, const std::string& path, std::string_view bytes,
                            const CadOptions& options) {
    try {
        return tessellate(read_shape(format, path, bytes), options);
    } catch (const Standard_Failure& failure) {
        std::string what = "Open CASCADE fails on it: ";
        what += failure.DynamicType()->Name();
        fail(std::move(what));
    }
}

}  // namespace hex::io

#endif
