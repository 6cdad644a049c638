#pragma once

// Shapes in Mitsuba's scene files.

#include <lightswitch/load/mitsuba_material.hpp>
#include <lightswitch/load/obj.hpp>
#include <lightswitch/load/ply.hpp>
#include <lightswitch/load/serialized.hpp>

namespace lightswitch::detail {

/// Reads the shapes, groups and instances of one scene file into a description.
class ShapeReader {
public:
    ShapeReader(const XmlFile& file, TextureReader& textures, MaterialReader& materials, LibraryDescription& scene)
        : file_(file), textures_(textures), materials_(materials), scene_(scene) {}

    /// Reads a `<shape>` of the scene; one that cannot be read is left out.
    void read(pugi::xml_node node) {
        file_.log().attempt("it is left out", [&] {
            XmlElement element(file_, node);
            if (element.type() == "shapegroup") read_group(node);
            else if (element.type() == "instance") read_instance(element);
            else scene_.shapes.push_back(read_shape(element));
        });
    }

private:
    LibraryDescription::Shape read_shape(XmlElement& element) {
        const auto bsdf = element.object("bsdf");
        const auto light = element.object("emitter");
        LibraryDescription::Shape shape;
        shape.origin = element.origin();
        if (light) file_.log().attempt("it does not shine", [&] { read_area_light(*light, shape); });
        shape.geometry = read_geometry(element);
        std::visit([&](const auto& geometry) { check(geometry, shape.origin); }, shape.geometry);
        if (shape.emission_texture && std::holds_alternative<Sphere>(shape.geometry)) {
            element.problem("", "only meshes can have a texture for their radiance, and this is a sphere",
                            "it shines with the texture's mean");
            shape.emission = shape.emission_texture->mean();
            shape.emission_texture.reset();
        }
        element.refuse_media();
        element.finish();
        shape.material = material_of(bsdf, shape.emission.has_value(), element.origin());
        if (shape.emission && is_masked(scene_, shape.material)) {
            element.problem("", "a surface that shines cannot be masked", "the mask is left out");
            shape.material = materials_.unmasked(shape.material, true, element.origin());
        }
        return shape;
    }

    std::size_t material_of(const std::optional<pugi::xml_node>& bsdf, bool light, const Origin& origin) {
        if (!bsdf) return materials_.by_default(light, origin);
        if (light && std::string_view(bsdf->attribute("type").value()) == "null")
            return materials_.invisible_light(file_.origin(*bsdf));
        return materials_.read(*bsdf);
    }

    void read_area_light(pugi::xml_node node, LibraryDescription::Shape& shape) {
        XmlElement element(file_, node);
        if (element.type() != "area") element.unknown_type("area, for a shape");
        if (element.has("to_world")) fail(element.origin("to_world"), "an area light is where its shape is");
        Rgb emission(1);
        std::optional<Texture> texture;
        if (const auto inner = element.texture("radiance")) texture = textures_.read(*inner);
        else emission = element.color("radiance", 1, SpectrumUse::emission);
        for (const Rgb& value : {emission, texture ? texture->least() : emission, texture ? texture->most() : emission})
            if (const std::string problem = radiance_problem(value, "the light's radiance"); !problem.empty())
                element.error(problem);
        element.finish();
        shape.emission = emission;
        shape.emission_texture = texture;
    }

    void read_instance(XmlElement& element) {
        const DMat4 to_world = element.transform("to_world").value_or(DMat4(1));
        const auto inner = element.objects("shape");
        if (inner.size() != 1) element.error("needs one shapegroup, not " + std::to_string(inner.size()));
        element.finish();
        if (const std::string problem = instance_problem(to_world); !problem.empty()) element.error(problem);
        scene_.instances.push_back({read_group(inner[0]), to_world, element.origin()});
    }

    /// Index of the group of a `<shape type="shapegroup">`, which is read once.
    std::size_t read_group(pugi::xml_node node) {
        const auto known = groups_.find(node);
        if (known != groups_.end()) return known->second;
        XmlElement element(file_, node);
        if (element.type() != "shapegroup") element.error("an instance is of a shapegroup");
        LibraryDescription::Group group{.shapes = {}, .origin = element.origin()};
        for (const auto shape : element.objects("shape"))
            file_.log().attempt("it is left out", [&] {
                XmlElement inner(file_, shape);
                if (inner.type() == "shapegroup" || inner.type() == "instance")
                    inner.error("a shapegroup cannot hold other groups or instances");
                group.shapes.push_back(read_shape(inner));
            });
        element.finish();
        if (group.shapes.empty()) element.error("the group has no shapes");
        scene_.groups.push_back(std::move(group));
        return groups_[node] = scene_.groups.size() - 1;
    }

    std::variant<Mesh, Sphere> read_geometry(XmlElement& element) {
        const DMat4 to_world = element.transform("to_world").value_or(DMat4(1));
        const bool flip = element.boolean("flip_normals", false);
        const std::string type = element.type();
        if (type == "sphere") return read_sphere(element, to_world, flip);
        if (type == "obj" || type == "ply" || type == "serialized") return read_mesh_file(element, to_world, flip);
        if (type == "cylinder") return read_cylinder(element, to_world, flip);
        Mesh mesh;
        if (type == "rectangle") mesh = rectangle(to_world);
        else if (type == "cube") mesh = cube(to_world);
        else if (type == "disk") mesh = disk(to_world);
        else element.unknown_type("rectangle, cube, disk, sphere, cylinder, obj, ply and serialized");
        if (type != "disk") element.accept({"face_normals"});  // they are flat anyway
        return flip ? std::move(mesh).flipped() : std::move(mesh);
    }

    static Sphere read_sphere(XmlElement& element, const DMat4& to_world, bool flip) {
        const DVec3 center = element.vector("center").value_or(DVec3(0));
        const double radius = element.positive("radius", 1, "; flip_normals turns a sphere inside out");
        const auto sphere = Sphere{.center = center, .radius = radius, .inward = flip}.transformed(to_world);
        if (!sphere)
            fail(element.origin("to_world"),
                 "a sphere must stay one: only the same scale in all directions is allowed");
        return *sphere;
    }

    static Mesh read_cylinder(XmlElement& element, const DMat4& to_world, bool flip) {
        const DVec3 from = element.vector("p0").value_or(DVec3(0)), to = element.vector("p1").value_or(DVec3(0, 0, 1));
        const double radius = element.positive("radius", 1);
        const double length = glm::length(to - from);
        if (!(length > 0)) element.error("\"p0\" and \"p1\" are the same point");
        const DVec3 axis = (to - from) / length, side = any_tangent(axis);
        const DMat4 placed(glm::dvec4(radius * side, 0), glm::dvec4(radius * glm::cross(axis, side), 0),
                           glm::dvec4(to - from, 0), glm::dvec4(from, 1));
        Mesh mesh = cylinder(to_world * placed);
        return flip ? std::move(mesh).flipped()
                    : std::move(mesh);  // a reflection leaves its front outside, as in Mitsuba 3.9
    }

    Mesh read_mesh_file(XmlElement& element, const DMat4& to_world, bool flip) {
        const std::filesystem::path path = element.file_name();
        const std::string type = element.type();
        const bool flat = element.boolean("face_normals", false);
        // Mitsuba's defaults: most OBJ files have the origin of images at the top.
        const bool flip_v = element.boolean("flip_tex_coords", type == "obj");
        const int index = type == "serialized" ? element.integer("shape_index", 0).value_or(0) : 0;
        const auto crease = element.is_old() ? element.number("max_smooth_angle") : std::nullopt;
        if (flat && crease)
            element.problem("max_smooth_angle", "give either it or face_normals", "the triangles are flat");
        const FileNormals use = flat || crease ? FileNormals::ignore : FileNormals::use;
        element.accept({"collapse"});
        Notices notices;
        Mesh mesh = at_place(element.origin(), [&] {
            return type == "obj"   ? load_obj(path, use, &notices)
                   : type == "ply" ? load_ply(path, use, &notices)
                                   : load_serialized(path, index, use, &notices);
        });
        for (std::string& notice : notices) file_.log().notice(std::move(notice));

        if (flip_v)
            for (Vec2& uv : mesh.uvs) uv.y = 1 - uv.y;
        const bool has_normals = !mesh.normals.empty();
        mesh = std::move(mesh).transformed(to_world);
        // As in Mitsuba 3.9, where there are no normals in the file a reflection turns the winding, and so the mesh
        // inside out.
        if (!has_normals && linear_determinant(to_world) < 0) mesh = std::move(mesh).flipped();
        if (crease && !flat) mesh.split_creases(*crease);
        if (!has_normals && !flat) mesh.smooth();
        return flip ? std::move(mesh).flipped() : std::move(mesh);
    }

    const XmlFile& file_;
    TextureReader& textures_;
    MaterialReader& materials_;
    LibraryDescription& scene_;
    std::map<pugi::xml_node, std::size_t> groups_;
};

}  // namespace lightswitch::detail
