// Makes the sample parts that come as STEP files, with Open CASCADE.   ninja make_step_parts &&
// bin/make_step_parts data
//
// angle: an angle bracket, 60 x 40 x 40 mm, 8 mm thick, a fillet of 6 mm inside, two holes of 10 mm in the
// foot and one of 14 mm in the wall. pair: two plates of different size side by side, an assembly of two
// solids.
#include <BRepAlgoAPI_Cut.hxx>
#include <BRepAlgoAPI_Fuse.hxx>
#include <BRepFilletAPI_MakeFillet.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <BRepTools.hxx>
#include <BRep_Builder.hxx>
#include <BRep_Tool.hxx>
#include <IGESControl_Writer.hxx>
#include <STEPControl_Writer.hxx>
#include <ShapeUpgrade_UnifySameDomain.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Compound.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Vertex.hxx>
#include <gp_Ax2.hxx>

#include <cmath>
#include <cstdio>
#include <string>

namespace {

TopoDS_Shape box(double x, double y, double z, double dx, double dy, double dz) {
    return BRepPrimAPI_MakeBox(gp_Pnt(x, y, z), dx, dy, dz).Shape();
}

TopoDS_Shape cylinder(const gp_Pnt& foot, const gp_Dir& axis, double radius, double height) {
    return BRepPrimAPI_MakeCylinder(gp_Ax2(foot, axis), radius, height).Shape();
}

TopoDS_Shape angle() {
    const TopoDS_Shape joined = BRepAlgoAPI_Fuse(box(0, 0, 0, 60, 40, 8), box(0, 0, 8, 60, 8, 32)).Shape();
    // Faces that a union leaves cut in two become one.
    ShapeUpgrade_UnifySameDomain unify(joined);
    unify.Build();
    const TopoDS_Shape body = unify.Shape();
    BRepFilletAPI_MakeFillet fillet(body);
    for (TopExp_Explorer it(body, TopAbs_EDGE); it.More(); it.Next()) {
        const TopoDS_Edge edge = TopoDS::Edge(it.Current());
        const gp_Pnt a = BRep_Tool::Pnt(TopExp::FirstVertex(edge));
        const gp_Pnt b = BRep_Tool::Pnt(TopExp::LastVertex(edge));
        const auto inside = [](const gp_Pnt& p) {
            return std::abs(p.Y() - 8) < 1e-9 && std::abs(p.Z() - 8) < 1e-9;
        };
        if (inside(a) && inside(b)) fillet.Add(6, edge);
    }
    TopoDS_Shape part = fillet.Shape();
    for (const double x : {15.0, 45.0})
        part = BRepAlgoAPI_Cut(part, cylinder(gp_Pnt(x, 27, -1), gp_Dir(0, 0, 1), 5, 10)).Shape();
    return BRepAlgoAPI_Cut(part, cylinder(gp_Pnt(30, -1, 27), gp_Dir(0, 1, 0), 7, 10)).Shape();
}

TopoDS_Shape pair() {
    TopoDS_Compound both;
    BRep_Builder builder;
    builder.MakeCompound(both);
    builder.Add(both, box(0, 0, 0, 30, 20, 10));
    builder.Add(
        both, BRepAlgoAPI_Cut(box(40, 0, 0, 20, 20, 20), cylinder(gp_Pnt(50, 10, -1), gp_Dir(0, 0, 1), 5, 22))
                  .Shape());
    return both;
}

bool write(const TopoDS_Shape& shape, const std::string& file) {
    STEPControl_Writer writer;
    return writer.Transfer(shape, STEPControl_AsIs) == IFSelect_RetDone &&
           writer.Write(file.c_str()) == IFSelect_RetDone;
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 2) {
        std::fprintf(
            stderr,
            "make_step_parts FOLDER: writes FOLDER/angle/angle.step, FOLDER/pair/pair.step .igs .brep\n");
        return 2;
    }
    const std::string folder = argv[1];
    bool good = write(angle(), folder + "/angle/angle.step");
    good = good && write(pair(), folder + "/pair/pair.step");
    IGESControl_Writer iges("MM", 0);
    iges.AddShape(pair());
    iges.ComputeModel();
    good = good && iges.Write((folder + "/pair/pair.igs").c_str());
    good = good && BRepTools::Write(pair(), (folder + "/pair/pair.brep").c_str());
    return good ? 0 : 1;
}
