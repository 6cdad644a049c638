#pragma once

// Images that material files of OBJ name.

#include <lightswitch/load/find_file.hpp>
#include <lightswitch/load/mtl.hpp>
#include <lightswitch/load/texture_memory.hpp>
#include <lightswitch/texture/load_bitmap.hpp>
#include <lightswitch/texture/texture.hpp>

#include <map>
#include <memory>
#include <set>
#include <tuple>

namespace lightswitch::detail {

/// The images of material files, each read once for each way in which it is used.
class MtlTextures {
public:
    /// How values are used: as they are, as a fraction of light (limited to 1), or as light.
    enum class Use { raw, fraction, raw_fraction, light };

    MtlTextures(std::vector<std::filesystem::path> folders, FileNotices& notices)
        : folders_(std::move(folders)), notices_(notices) {}

    /// The texture times `factor`; nothing, and a notice, when there is no image that can be read.
    std::optional<Texture> read(const MtlMap& map, Use use, const Rgb& factor = Rgb(1)) {
        const auto& path = find(map.file);
        if (!path) {
            notices_.add(map.origin, "there is no image " + quote(map.file) + ": the material does without it");
            return {};
        }
        auto& bitmap = bitmaps_[{path->string(), use, map.clamp, map.base, map.gain, factor.x, factor.y, factor.z}];
        if (!bitmap) {
            files_.insert(path->string());
            try {
                bitmap = std::make_shared<const Bitmap>(bitmap_of(*path, map, use, factor));
            } catch (const Error& error) {
                notices_.add(map.origin, "the material does without an image: " + std::string(error.what()));
                return {};
            }
            memory_.add(bitmap->bytes(), map.origin);
        }
        // In OBJ v grows upwards.
        const Vec3 scale(map.scale), offset(map.offset);
        Texture texture(bitmap, {.u = {scale.x, 0, offset.x}, .v = {0, -scale.y, 1 - offset.y}});
        if (const std::string problem = texture.problem(); !problem.empty()) fail(map.origin, problem);
        return texture;
    }

    /// Those that were opened, whether or not they could be read.
    const std::set<std::string>& files() const { return files_; }

private:
    /// The file of that name; each is looked for once, since that may go through whole folders.
    const std::optional<std::filesystem::path>& find(const std::string& name) {
        const auto [entry, is_new] = found_.try_emplace(name);
        if (is_new) entry->second = find_loosely(name, folders_);
        return entry->second;
    }

    Bitmap bitmap_of(const std::filesystem::path& path, const MtlMap& map, Use use, const Rgb& factor) const {
        const TextureWrap wrap = map.clamp ? TextureWrap::clamp : TextureWrap::repeat;
        const bool is_raw = use == Use::raw || use == Use::raw_fraction;
        Bitmap bitmap = load_bitmap(path, {.raw = is_raw, .wrap = wrap});
        if (const std::string problem = bitmap.problem(); !problem.empty()) throw Error(path.string() + ": " + problem);
        const float most = use == Use::fraction || use == Use::raw_fraction ? 1.0f : 65504.0f;
        const bool is_fit =
            use == Use::raw || (min_component(bitmap.least()) >= 0 && max_component(bitmap.most()) <= most);
        if (is_fit && map.base == 0 && map.gain == 1 && factor == Rgb(1)) return bitmap;

        const float least = use == Use::raw ? -65504.0f : 0.0f;
        const auto base = static_cast<float>(map.base), gain = static_cast<float>(map.gain);
        std::vector<Half> values;
        values.reserve(3 * static_cast<std::size_t>(bitmap.width()) * static_cast<std::size_t>(bitmap.height()));
        for (int y = 0; y < bitmap.height(); ++y)
            for (int x = 0; x < bitmap.width(); ++x) {
                const Rgb value = (base + gain * bitmap.texel(x, y)) * factor;
                for (int c = 0; c < 3; ++c) values.emplace_back(std::clamp(value[c], least, most));
            }
        return Bitmap(bitmap.width(), bitmap.height(), std::move(values), TexelEncoding::linear, {.wrap = wrap});
    }

    std::vector<std::filesystem::path> folders_;
    FileNotices& notices_;
    std::map<std::tuple<std::string, Use, bool, double, double, float, float, float>, std::shared_ptr<const Bitmap>>
        bitmaps_;
    std::set<std::string> files_;
    TextureMemory memory_;
    std::map<std::string, std::optional<std::filesystem::path>, std::less<>> found_;  ///< by the name in the file
};

}  // namespace lightswitch::detail
