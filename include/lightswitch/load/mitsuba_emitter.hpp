#pragma once

// Emitters in Mitsuba's scene files that belong to no shape.

#include <lightswitch/load/xml_color.hpp>
#include <lightswitch/scene/library.hpp>
#include <lightswitch/texture/load_bitmap.hpp>

namespace lightswitch::detail {

/// Reads the emitters of one scene file into a description.
class EmitterReader {
public:
    EmitterReader(const XmlFile& file, LibraryDescription& scene) : file_(file), scene_(scene) {}

    /// Reads an `<emitter>`; one that cannot be read is left out.
    void read(pugi::xml_node node) {
        file_.log().attempt("it is left out", [&] { read_known(node); });
    }

private:
    void read_known(pugi::xml_node node) {
        XmlElement element(file_, node);
        const auto to_world = element.transform("to_world");
        const auto emission = [&](const char* name) { return element.color(name, 1, SpectrumUse::emission); };
        if (element.type() == "point") {
            const auto position = element.vector("position");
            if (position && to_world) element.problem("to_world", "give either position or to_world", "it is ignored");
            add(element, PointSource{.position = position.value_or(to_world ? DVec3((*to_world)[3]) : DVec3(0)),
                                     .intensity = emission("intensity")});
        } else if (element.type() == "directional") {
            const auto direction = element.vector("direction");
            if (direction && to_world)
                element.problem("to_world", "give either direction or to_world", "it is ignored");
            add(element,
                DirectionalSource{.direction = direction.value_or(to_world ? DVec3((*to_world)[2]) : DVec3(0, 0, 1)),
                                  .irradiance = emission("irradiance")});
        } else if (element.type() == "constant") {
            add_environment(element, EnvironmentSource{.radiance = emission("radiance")});
        } else if (element.type() == "envmap") {
            read_environment_map(element, to_world);
        } else if (element.type() == "sky" || element.type() == "sunsky") {
            element.problem("", "skies are not supported", "a constant environment of radiance 1 takes its place");
            element.accept_rest();
            add_environment(element, EnvironmentSource{.radiance = Rgb(1)});
        } else if (element.type() == "spot") {
            const double cutoff = element.number("cutoff_angle", 20);
            add(element, SpotSource{.position = to_world ? DVec3((*to_world)[3]) : DVec3(0),
                                    .direction = to_world ? DVec3((*to_world)[2]) : DVec3(0, 0, 1),
                                    .intensity = emission("intensity"),
                                    .cutoff_angle = cutoff,
                                    .beam_width = element.number("beam_width", 0.75 * cutoff)});
        } else if (element.type() == "area") {
            if (!node.attribute("id")) element.error("an area light must be inside a <shape>");
            element.accept_rest();  // shapes refer to it
        } else {
            element.unknown_type("point, spot, directional, constant, envmap, and area inside a shape");
        }
        element.finish();
    }

    void add(const XmlElement& element, Source source) {
        if (const std::string problem = source.problem(); !problem.empty()) element.error(problem);
        scene_.add(std::move(source), element.origin());
    }

    void add_environment(const XmlElement& element, Source source) {
        if (has_environment_) element.error("is the second environment of the scene");
        add(element, std::move(source));
        has_environment_ = true;
    }

    void read_environment_map(XmlElement& element, const std::optional<DMat4>& to_world) {
        const std::filesystem::path path = element.file_name();
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
        add_environment(element, std::move(source));
    }

    const XmlFile& file_;
    LibraryDescription& scene_;
    bool has_environment_ = false;
};

}  // namespace lightswitch::detail
