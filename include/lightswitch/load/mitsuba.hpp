#pragma once

// Scene files of Mitsuba 3 (a subset of its XML).

#include <lightswitch/load/mitsuba_camera.hpp>
#include <lightswitch/load/mitsuba_material.hpp>
#include <lightswitch/load/obj.hpp>
#include <lightswitch/load/ply.hpp>

namespace lightswitch {

/// Reads a scene file of Mitsuba 3, as its RGB variants see it; `defines` give `$name` a value, before any `<default>`.
///
/// Supported are the integrator `path`; the sensors `perspective` and `thinlens` with `hdrfilm`; the shapes
/// `rectangle`, `cube`, `disk`, `sphere`, `obj` and `ply`; the bsdfs `diffuse`, `conductor`, `roughconductor` (GGX),
/// `dielectric` and `twosided`; the emitters `area`, `point`, `directional` and `constant`. What is left out has
/// Mitsuba's default, but for the clipping planes, which are then at 0 and infinity. File names are relative to the
/// scene file.
///
/// Throws `Error` with file, line and element for everything that it cannot honour. Only mesh files may hold what is
/// skipped or guessed, which `notices` tells (see `load_obj` and `load_ply`). Thread safe.
LibraryDescription load_mitsuba(const std::filesystem::path& file,
                                const std::map<std::string, std::string>& defines = {}, Notices* notices = nullptr);

namespace detail {

class MitsubaReader {
public:
    MitsubaReader(const std::filesystem::path& path, const std::map<std::string, std::string>& defines,
                  Notices* notices)
        : folder_(path.parent_path()),
          file_(path, defines),
          textures_(file_, folder_),
          materials_(file_, textures_, scene_),
          notices_(notices) {
        scene_.name = path.stem().string();
        scene_.files.push_back(path.string());
    }

    LibraryDescription read() {
        const pugi::xml_node root = file_.root();
        if (std::string_view(root.name()) != "scene")
            fail(file_.origin(root), "the root of a scene file must be <scene>");
        XmlElement element(file_, root);
        check_version(root);

        // Textures and BSDFs first: those that nothing uses are checked too.
        for (const auto node : element.objects({"texture"})) textures_.read(node);
        LibraryDescription unused;
        MaterialReader checked(file_, textures_, unused);
        for (const auto node : element.objects({"bsdf"})) checked.read(node);
        if (const auto node = at_most_one(element, "integrator")) read_integrator(file_, *node, scene_);
        const auto sensor = at_most_one(element, "sensor");
        if (!sensor) element.error("there is no camera: add a <sensor>");
        read_sensor(file_, *sensor, scene_);
        for (const auto node : element.objects({"shape"})) read_shape(node);
        for (const auto node : element.objects({"emitter"})) read_emitter(node);
        element.finish();
        for (std::string& file : textures_.files()) scene_.files.push_back(std::move(file));
        return std::move(scene_);
    }

private:
    void check_version(pugi::xml_node root) {
        const std::string version = root.attribute("version").value();
        const auto major = parse_integer(std::string_view(version).substr(0, version.find('.')));
        if (!major || version.find_first_not_of("0123456789.") != std::string::npos)
            fail(file_.origin(root), quote(version) + " is not a version such as \"3.0.0\"");
        if (*major != 2 && *major != 3)
            fail(file_.origin(root),
                 "is of version " + version + ", but only versions 2 and 3 of the format are known");
    }

    void read_shape(pugi::xml_node node) {
        XmlElement element(file_, node);
        if (element.type() == "shapegroup") {
            read_group(node);
        } else if (element.type() == "instance") {
            read_instance(element);
        } else {
            scene_.shapes.push_back(read_one_shape(element));
        }
    }

    LibraryDescription::Shape read_one_shape(XmlElement& element) {
        const auto bsdfs = element.objects({"bsdf", "ref"});
        if (bsdfs.size() > 1) fail(file_.origin(bsdfs[1]), "is the second bsdf of the shape");
        const auto light = at_most_one(element, "emitter");
        LibraryDescription::Shape shape;
        if (light) read_area_light(*light, shape);
        shape.geometry = read_geometry(element);
        element.finish();
        shape.material = material_of(bsdfs, light.has_value(), element.origin());
        shape.origin = element.origin();
        return shape;
    }

    std::size_t material_of(const std::vector<pugi::xml_node>& bsdfs, bool light, const Origin& origin) {
        if (bsdfs.empty()) return materials_.by_default(light, origin);
        const bool reference = std::string_view(bsdfs[0].name()) == "ref";
        const pugi::xml_node bsdf = reference ? file_.target(bsdfs[0], "bsdf") : bsdfs[0];
        if (light && std::string_view(bsdf.attribute("type").value()) == "null")
            return materials_.invisible_light(file_.origin(bsdf));
        return materials_.read(bsdf);
    }

    void read_instance(XmlElement& element) {
        const DMat4 to_world = element.transform("to_world").value_or(DMat4(1));
        const auto inner = element.objects({"shape", "ref"});
        if (inner.size() != 1) element.error("needs one shapegroup, not " + std::to_string(inner.size()));
        element.finish();
        const bool reference = std::string_view(inner[0].name()) == "ref";
        scene_.instances.push_back(
            {read_group(reference ? file_.target(inner[0], "shape") : inner[0]), to_world, element.origin()});
    }

    /// Index of the group of a `<shape type="shapegroup">`, which is read once.
    std::size_t read_group(pugi::xml_node node) {
        const auto known = groups_.find(node.offset_debug());
        if (known != groups_.end()) return known->second;
        XmlElement element(file_, node);
        if (element.type() != "shapegroup") element.error("an instance is of a shapegroup");
        LibraryDescription::Group group{.shapes = {}, .origin = element.origin()};
        for (const auto shape : element.objects({"shape"})) {
            XmlElement inner(file_, shape);
            if (inner.type() == "shapegroup" || inner.type() == "instance")
                inner.error("a shapegroup cannot hold other groups or instances");
            group.shapes.push_back(read_one_shape(inner));
        }
        element.finish();
        scene_.groups.push_back(std::move(group));
        return groups_[node.offset_debug()] = scene_.groups.size() - 1;
    }

    std::variant<Mesh, Sphere> read_geometry(XmlElement& element) {
        const DMat4 to_world = element.transform("to_world").value_or(DMat4(1));
        const bool flip = element.boolean("flip_normals", false);
        const std::string type = element.type();
        if (type == "sphere") return read_sphere(element, to_world, flip);
        if (type == "obj" || type == "ply") return read_mesh_file(element, to_world, flip);
        Mesh mesh;
        if (type == "rectangle") mesh = rectangle(to_world);
        else if (type == "cube") mesh = cube(to_world);
        else if (type == "disk") mesh = disk(to_world);
        else element.unknown_type("rectangle, cube, disk, sphere, obj and ply");
        if (type != "disk") element.boolean("face_normals", false);  // they are flat anyway
        return flip ? mesh.flipped() : mesh;
    }

    static Sphere read_sphere(XmlElement& element, const DMat4& to_world, bool flip) {
        const DVec3 center = element.vector("center").value_or(DVec3(0));
        const double radius = element.number("radius", 1);
        if (!(radius > 0)) fail(element.origin("radius"), "must be above 0; flip_normals turns a sphere inside out");
        const auto sphere = Sphere{.center = center, .radius = radius, .inward = flip}.transformed(to_world);
        if (!sphere)
            fail(element.origin("to_world"),
                 "a sphere must stay one: only the same scale in all directions is allowed");
        return *sphere;
    }

    Mesh read_mesh_file(XmlElement& element, const DMat4& to_world, bool flip) {
        const std::filesystem::path file = element.file_name(folder_);
        const bool flat = element.boolean("face_normals", false);
        // Mitsuba's defaults: most OBJ files have the origin of images at the top.
        const bool flip_v = element.boolean("flip_tex_coords", element.type() == "obj");
        const FileNormals use = flat ? FileNormals::ignore : FileNormals::use;
        scene_.files.push_back(file.string());
        Notices notices;
        Mesh mesh = at_place(element.origin(), [&] {
            return element.type() == "obj" ? load_obj(file, use, &notices) : load_ply(file, use, &notices);
        });
        if (notices_ != nullptr)
            for (std::string& notice : notices)
                if (noticed_.insert(notice).second) notices_->push_back(std::move(notice));

        if (flip_v)
            for (Vec2& uv : mesh.uvs) uv.y = 1 - uv.y;
        const bool has_normals = !mesh.normals.empty();
        mesh = mesh.transformed(to_world);
        // As in Mitsuba 3.9, where there are no normals in the file a reflection turns the winding, and so the mesh
        // inside out.
        if (!has_normals && linear_determinant(to_world) < 0) mesh = mesh.flipped();
        if (!has_normals && !flat) mesh.smooth();
        return flip ? mesh.flipped() : mesh;
    }

    void read_area_light(pugi::xml_node node, LibraryDescription::Shape& shape) {
        XmlElement element(file_, node);
        if (element.type() != "area") element.unknown_type("area, for a shape");
        if (element.has("to_world")) fail(element.origin("to_world"), "an area light is where its shape is");
        if (const auto texture = element.texture("radiance")) {
            shape.emission = Rgb(1);
            shape.emission_texture = textures_.read(*texture);
        } else {
            shape.emission = element.color("radiance", 1, SpectrumUse::emission);
        }
        element.finish();
    }

    void read_emitter(pugi::xml_node node) {
        XmlElement element(file_, node);
        const auto to_world = element.transform("to_world");
        const auto emission = [&](const char* name) { return element.color(name, 1, SpectrumUse::emission); };
        if (element.type() == "point") {
            const auto position = element.vector("position");
            if (position && to_world) element.error("give either position or to_world");
            scene_.add(PointSource{.position = position.value_or(to_world ? DVec3((*to_world)[3]) : DVec3(0)),
                                   .intensity = emission("intensity")},
                       element.origin());
        } else if (element.type() == "directional") {
            const auto direction = element.vector("direction");
            if (direction && to_world) element.error("give either direction or to_world");
            scene_.add(
                DirectionalSource{.direction = direction.value_or(to_world ? DVec3((*to_world)[2]) : DVec3(0, 0, 1)),
                                  .irradiance = emission("irradiance")},
                element.origin());
        } else if (element.type() == "constant") {
            only_environment(element);
            scene_.add(EnvironmentSource{.radiance = emission("radiance")}, element.origin());
        } else if (element.type() == "envmap") {
            only_environment(element);
            read_environment_map(element, to_world);
        } else if (element.type() == "spot") {
            const double cutoff = element.number("cutoff_angle", 20);
            scene_.add(SpotSource{.position = to_world ? DVec3((*to_world)[3]) : DVec3(0),
                                  .direction = to_world ? DVec3((*to_world)[2]) : DVec3(0, 0, 1),
                                  .intensity = emission("intensity"),
                                  .cutoff_angle = cutoff,
                                  .beam_width = element.number("beam_width", 0.75 * cutoff)},
                       element.origin());
        } else if (element.type() == "area") {
            element.error("an area light must be inside a <shape>");
        } else {
            element.unknown_type("point, spot, directional, constant, envmap, and area inside a shape");
        }
        element.finish();
    }

    void only_environment(const XmlElement& element) {
        if (std::exchange(has_environment_, true)) element.error("is the second environment of the scene");
    }

    void read_environment_map(XmlElement& element, const std::optional<DMat4>& to_world) {
        const std::filesystem::path path = element.file_name(folder_);
        EnvironmentMapSource source{.map = {}, .scale = element.number("scale", 1)};
        source.map = at_place(element.origin(), [&] {
            const Bitmap bitmap = load_bitmap(path);
            std::vector<Rgb> texels;
            texels.reserve(static_cast<std::size_t>(bitmap.width()) * static_cast<std::size_t>(bitmap.height()));
            for (int y = 0; y < bitmap.height(); ++y)
                for (int x = 0; x < bitmap.width(); ++x) texels.push_back(bitmap.texel(x, y));
            return std::make_shared<const EnvironmentMap>(std::move(texels), bitmap.width(), bitmap.height());
        });
        if (to_world) source.to_world = DMat3(*to_world);
        scene_.files.push_back(path.string());
        scene_.add(std::move(source), element.origin());
    }

    std::filesystem::path folder_;
    XmlFile file_;
    TextureReader textures_;
    LibraryDescription scene_;
    MaterialReader materials_;
    Notices* notices_;
    std::set<std::string> noticed_;  ///< several shapes may use one file
    std::map<std::ptrdiff_t, std::size_t> groups_;
    bool has_environment_ = false;
};

}  // namespace detail

inline LibraryDescription load_mitsuba(const std::filesystem::path& file,
                                       const std::map<std::string, std::string>& defines, Notices* notices) {
    return detail::MitsubaReader(file, defines, notices).read();
}

}  // namespace lightswitch
