#pragma once

// Scene files of Mitsuba.

#include <lightswitch/load/mitsuba_camera.hpp>
#include <lightswitch/load/mitsuba_emitter.hpp>
#include <lightswitch/load/mitsuba_shape.hpp>
#include <lightswitch/load/scene_file.hpp>
#include <lightswitch/scene/framing.hpp>

namespace lightswitch {

namespace detail {

class MitsubaReader {
public:
    MitsubaReader(const std::filesystem::path& path, const MitsubaOptions& options, ReadingLog& log)
        : options_(options), log_(log), file_(path, options.defines, options.search_paths, log) {
        scene_.name = path.stem().string();
    }

    LibraryDescription read() {
        const pugi::xml_node root = file_.root();
        if (std::string_view(root.name()) != "scene")
            fail(file_.origin(root), "the root of a scene file must be <scene>");
        XmlElement element(file_, root);

        // Textures and BSDFs first: those that nothing uses are checked too.
        TextureReader textures(file_);
        MaterialReader materials(file_, textures, scene_);
        for (const auto node : element.objects("texture")) textures.read(node);
        LibraryDescription unused;
        MaterialReader checked(file_, textures, unused);
        for (const auto node : element.objects("bsdf")) checked.read(node);
        if (const auto node = element.object("integrator"))
            log_.attempt("it is ignored", [&] { read_integrator(file_, *node, scene_); });
        const auto sensors = element.objects("sensor");
        if (!sensors.empty()) {
            const auto sensor = choose(sensors);
            log_.attempt(default_camera, [&] { read_sensor(file_, sensor, scene_); });
        }
        ShapeReader shapes(file_, textures, materials, scene_);
        for (const auto node : element.objects("shape")) shapes.read(node);
        EmitterReader emitters(file_, scene_);
        for (const auto node : element.objects("emitter")) emitters.read(node);
        drop_parts_of_sensors(element);
        element.refuse_media();
        element.finish();
        if (sensors.empty()) place_camera(element);
        scene_.files = log_.files();
        return std::move(scene_);
    }

private:
    static constexpr const char* default_camera = "a camera at the origin that looks along z takes its place";

    pugi::xml_node choose(const std::vector<pugi::xml_node>& sensors) const {
        const std::string& wanted = options_.sensor;
        if (wanted.empty()) {
            if (sensors.size() > 1)
                log_.notice(file_.origin(sensors[1]),
                            "is one of " + std::to_string(sensors.size()) + " sensors: the first is used");
            return sensors[0];
        }
        std::string ids;
        for (const auto sensor : sensors) {
            const std::string id = sensor.attribute("id").value();
            if (id == wanted) return sensor;
            if (!id.empty()) ids += ", " + quote(id);
        }
        const auto number = parse_integer(wanted);
        if (number && *number >= 0 && static_cast<std::size_t>(*number) < sensors.size())
            return sensors[static_cast<std::size_t>(*number)];
        fail({log_.files()[0], 0, {}},
             "there is no sensor " + quote(wanted) + "; known are 0 to " + std::to_string(sensors.size() - 1) + ids);
    }

    /// Those of no sensor, to which sensors may refer.
    void drop_parts_of_sensors(XmlElement& element) {
        for (const char* tag : {"sampler", "film", "rfilter"})
            for (const auto node : element.objects(tag))
                if (!node.attribute("id")) log_.notice(file_.origin(node), "is in no sensor, and is ignored");
    }

    void place_camera(const XmlElement& element) {
        if (!options_.sensor.empty()) element.error("there is no <sensor>, and so none to choose");
        scene_.film = default_film(element.origin());
        log_.notice(element.origin(), "there is no <sensor>: the camera is placed so that it sees all shapes");
        log_.attempt(default_camera, [&] { frame_scene(scene_); });
    }

    const MitsubaOptions& options_;
    ReadingLog& log_;
    XmlFile file_;
    LibraryDescription scene_;
};

}  // namespace detail

template <class Description>
Description load_mitsuba(const std::filesystem::path& file, const MitsubaOptions& options) {
    detail::ReadingLog log;
    const auto tell = [&] {
        if (options.notices)
            options.notices->insert(options.notices->end(), log.notices().begin(), log.notices().end());
        if (options.problems)
            options.problems->insert(options.problems->end(), log.problems().begin(), log.problems().end());
    };
    Description scene;
    try {
        scene = detail::MitsubaReader(file, options, log).read();
    } catch (const Error&) {
        tell();
        throw;
    }
    tell();
    if (options.strictness == Strictness::strict && !log.problems().empty()) throw UnsupportedScene(log.problems());
    return scene;
}

template <class Description>
Description load_mitsuba(const std::filesystem::path& file, const std::map<std::string, std::string>& defines,
                         Notices* notices) {
    return load_mitsuba<Description>(file, MitsubaOptions{.defines = defines, .notices = notices});
}

}  // namespace lightswitch
