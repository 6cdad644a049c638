// The images of the window, and the mouse on them.

#include "interface.hpp"

#include <lightswitch/compare/false_color.hpp>

#include <GLFW/glfw3.h>
#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>

namespace lightswitch::program {
namespace {

Difference difference_shown(View view) {
    return view == View::relative       ? Difference::relative
           : view == View::significance ? Difference::significance
                                        : Difference::absolute;
}

/// In one version of ImGui a pointer, in another a number.
ImTextureID drawn(const Texture& texture, bool enlarged) { return (ImTextureID)texture.handle(enlarged); }

constexpr float smallest_labelled = 64;  // pixels of the screen in which a pixel's three numbers find room

}  // namespace

/// Makes the pictures that the view needs again where their images or how they are shown have changed.
void Interface::update_pictures() {
    if (!live_) return;
    const bool changed = !(display_ == drawn_display_);
    drawn_display_ = display_;
    picture_of_snapshot(ours_, drawn_ours_, &live_->shown_method(), changed);
    const LiveMethod* reference = live_->reference_method();
    picture_of_snapshot(theirs_, drawn_theirs_, compares() ? reference : nullptr, changed);

    const bool numbers = view_ == View::difference || view_ == View::relative || view_ == View::significance;
    const bool both = numbers && reference && drawn_ours_ && drawn_theirs_ && drawn_ours_->iterations > 0 &&
                      drawn_theirs_->iterations > 0 && drawn_ours_->view == drawn_theirs_->view;
    if (!both) {
        numbers_.clear();
        numbers_ours_ = numbers_theirs_ = {};
    } else if (numbers_ours_ != drawn_ours_ || numbers_theirs_ != drawn_theirs_ || numbers_view_ != view_) {
        const Difference difference = difference_shown(view_);
        number_image_ = difference_of(difference, *drawn_ours_, *drawn_theirs_);
        const float scale = scale_of(difference, number_image_);
        numbers_.set(picture_of_numbers(number_image_, scale));
        if (scale != legend_scale_ || numbers_view_ != view_) legend_width_ = 0;
        legend_scale_ = scale;
        numbers_ours_ = drawn_ours_;
        numbers_theirs_ = drawn_theirs_;
        numbers_view_ = view_;
    }

    if (view_ < View::albedo) return;
    const auto outputs = live_->outputs();
    if (!outputs) {
        output_.clear();
        drawn_outputs_.reset();
    } else if (outputs != drawn_outputs_ || output_view_ != view_) {
        const Layer& layer = outputs->at(static_cast<std::size_t>(view_) - static_cast<std::size_t>(View::albedo));
        output_.set(picture_of_output(layer.name, layer.image));
        drawn_outputs_ = outputs;
        output_view_ = view_;
    }
}

void Interface::picture_of_snapshot(Texture& texture, std::shared_ptr<const Snapshot>& drawn, const LiveMethod* method,
                                    bool changed) {
    const auto snapshot = method ? method->snapshot : nullptr;
    if (!snapshot || snapshot->image.empty()) {
        texture.clear();
        drawn.reset();
    } else if (changed || snapshot != drawn) {
        texture.set(picture_of(snapshot->image, display_));
        drawn = snapshot;
    }
}

/// An area of the screen, and where the image lies when it is zoomed as it is.
Interface::Place Interface::place_in(float x, float y, float width, float height) const {
    const auto columns = static_cast<float>(live_->film().width), rows = static_cast<float>(live_->film().height);
    Place place{x, y, width, height, 0, 0, zoom_ * std::min(width / columns, height / rows)};
    place.left = x + width / 2 - static_cast<float>(center_.x) * columns * place.size;
    place.top = y + height / 2 - static_cast<float>(center_.y) * rows * place.size;
    if (place.size >= 2) {  // sharp edges
        place.left = std::round(place.left);
        place.top = std::round(place.top);
    }
    return place;
}

void Interface::image_area(float width, float height) {
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    ImGui::InvisibleButton(
        "image", {width, height},
        ImGuiButtonFlags_MouseButtonLeft | ImGuiButtonFlags_MouseButtonRight | ImGuiButtonFlags_MouseButtonMiddle);
    const bool hovered = ImGui::IsItemHovered(), active = ImGui::IsItemActive();
    if (!live_) {
        const char* text = "Drop a scene here, or open one with Ctrl+O";
        const ImVec2 size = ImGui::CalcTextSize(text);
        ImGui::GetWindowDrawList()->AddText({corner.x + (width - size.x) / 2, corner.y + (height - size.y) / 2},
                                            IM_COL32(200, 200, 200, 255), text);
        return;
    }
    const Place whole{corner.x, corner.y, width, height, 0, 0, 0};
    draw_views(whole);
    const float half = std::floor(width / 2);
    const float mouse = ImGui::GetIO().MousePos.x;
    const Place under = view_ != View::side_by_side ? place_in(corner.x, corner.y, width, height)
                        : mouse < corner.x + half   ? place_in(corner.x, corner.y, half - 1, height)
                                                    : place_in(corner.x + half + 1, corner.y, width - half - 1, height);
    if (hovered || active) handle_mouse(under);
    else drags_split_ = false;
}

void Interface::draw_views(const Place& whole) {
    ImDrawList& list = *ImGui::GetWindowDrawList();
    const LiveMethod& shown = live_->shown_method();
    const LiveMethod* reference = live_->reference_method();
    const auto title = [](const LiveMethod& method) {
        const auto& s = method.snapshot;
        if (s && !s->failure.empty()) return fmt::format("{}: {}", method.name, s->failure);
        if (s && s->iterations > 0) return fmt::format("{}, {} samples", method.name, s->iterations);
        return fmt::format("{}, {}", method.name, s ? "coarse" : "not begun");
    };
    const auto draw_one = [&](const Texture& texture, const std::shared_ptr<const Snapshot>& drawn, const Place& place,
                              const LiveMethod& method) {
        draw_texture(texture, place);
        if (drawn && drawn->iterations > 0) draw_values(place, drawn->image);
        draw_label(place, title(method));
    };
    const Place all = place_in(whole.x, whole.y, whole.width, whole.height);
    if (!compares() || !reference) {
        if (view_ < View::albedo) return draw_one(ours_, drawn_ours_, all, shown);
        draw_texture(output_, all);
        return draw_label(all, std::string(name(view_)));
    }
    const ImU32 line_color = IM_COL32(255, 210, 80, 255);
    if (view_ == View::side_by_side) {
        const float half = std::floor(whole.width / 2);
        draw_one(ours_, drawn_ours_, place_in(whole.x, whole.y, half - 1, whole.height), shown);
        draw_one(theirs_, drawn_theirs_, place_in(whole.x + half + 1, whole.y, whole.width - half - 1, whole.height),
                 *reference);
    } else if (view_ == View::split) {
        const float line = std::round(whole.x + split_ * whole.width);
        Place left = all, right = all;
        left.width = line - whole.x;
        right.x = line;
        right.width = whole.x + whole.width - line;
        draw_one(ours_, drawn_ours_, left, shown);
        draw_texture(theirs_, right);
        if (drawn_theirs_ && drawn_theirs_->iterations > 0) draw_values(right, drawn_theirs_->image);
        const std::string text = title(*reference);
        Place label = right;
        label.x = whole.x + whole.width - ImGui::CalcTextSize(text.c_str()).x - 16 * window_.scale();
        draw_label(label, text);
        list.AddLine({line, whole.y}, {line, whole.y + whole.height}, line_color, 2 * window_.scale());
    } else if (view_ == View::flicker) {
        const bool ours = std::fmod(ImGui::GetTime(), 1.0) < 0.5;
        draw_one(ours ? ours_ : theirs_, ours ? drawn_ours_ : drawn_theirs_, all, ours ? shown : *reference);
    } else {
        draw_texture(numbers_, all);
        if (!numbers_.empty()) {
            draw_values(all, number_image_);
            draw_legend(all);
        }
        const bool too_few =
            view_ == View::significance && !numbers_.empty() &&
            (numbers_ours_->iterations < least_iterations || numbers_theirs_->iterations < least_iterations);
        draw_label(all, fmt::format("{} - {}{}", shown.name, reference->name,
                                    numbers_.empty() ? ": waiting for both images"
                                    : too_few        ? ": below 16 samples the noise is not known well"
                                                     : ""));
    }
}

void Interface::draw_texture(const Texture& texture, const Place& place) {
    if (texture.empty()) return;
    const auto columns = static_cast<float>(live_->film().width), rows = static_cast<float>(live_->film().height);
    ImDrawList& list = *ImGui::GetWindowDrawList();
    // Only what is within the area: far beyond it, coordinates would lose their digits.
    const float left = std::max(place.left, place.x), top = std::max(place.top, place.y);
    const float right = std::min(place.left + columns * place.size, place.x + place.width);
    const float bottom = std::min(place.top + rows * place.size, place.y + place.height);
    if (!(left < right && top < bottom)) return;
    const auto u = [&](float x) { return (x - place.left) / (columns * place.size); };
    const auto v = [&](float y) { return (y - place.top) / (rows * place.size); };
    const bool coarse = texture.width() != live_->film().width;
    list.AddImage(drawn(texture, !coarse && place.size >= 1), {left, top}, {right, bottom}, {u(left), v(top)},
                  {u(right), v(bottom)});
    if (picked_) {
        const float x = place.left + static_cast<float>(picked_->first) * place.size;
        const float y = place.top + static_cast<float>(picked_->second) * place.size;
        const float out = std::max(0.0f, (9 - place.size) / 2);
        const auto frame = [&](float distance, ImU32 frame_color) {
            const float x0 = std::round(x - out - distance), x1 = std::round(x + place.size + out + distance);
            const float y0 = std::round(y - out - distance), y1 = std::round(y + place.size + out + distance);
            list.AddRectFilled({x0, y0}, {x1, y0 + 1}, frame_color);
            list.AddRectFilled({x0, y1 - 1}, {x1, y1}, frame_color);
            list.AddRectFilled({x0, y0}, {x0 + 1, y1}, frame_color);
            list.AddRectFilled({x1 - 1, y0}, {x1, y1}, frame_color);
        };
        list.PushClipRect({place.x, place.y}, {place.x + place.width, place.y + place.height}, true);
        frame(1, IM_COL32(255, 210, 80, 255));
        frame(2, IM_COL32(0, 0, 0, 255));
        list.PopClipRect();
    }
}

/// The numbers of the pixels, where they are large enough.
void Interface::draw_values(const Place& place, const Image& image) {
    if (place.size < smallest_labelled * window_.scale()) return;
    ImDrawList& list = *ImGui::GetWindowDrawList();
    const auto first = [&](float corner, float begin) {
        return std::max(0, static_cast<int>(std::floor((begin - corner) / place.size)));
    };
    const auto last = [&](float corner, float end, int count) {
        return std::min(count - 1, static_cast<int>(std::floor((end - corner) / place.size)));
    };
    list.PushClipRect({place.x, place.y}, {place.x + place.width, place.y + place.height}, true);
    for (int y = first(place.top, place.y); y <= last(place.top, place.y + place.height, image.height()); ++y)
        for (int x = first(place.left, place.x); x <= last(place.left, place.x + place.width, image.width()); ++x) {
            const Rgb& value = image(x, y);
            const std::string text = fmt::format("{:.4g}\n{:.4g}\n{:.4g}", value.x, value.y, value.z);
            const ImVec2 at{place.left + (static_cast<float>(x) + 0.06f) * place.size,
                            place.top + (static_cast<float>(y) + 0.06f) * place.size};
            list.AddText({at.x + 1, at.y + 1}, IM_COL32(0, 0, 0, 255), text.c_str());
            list.AddText(at, IM_COL32(255, 255, 255, 255), text.c_str());
        }
    list.PopClipRect();
}

void Interface::draw_label(const Place& place, const std::string& text) {
    ImDrawList& list = *ImGui::GetWindowDrawList();
    const float edge = 4 * window_.scale();
    const ImVec2 size = ImGui::CalcTextSize(text.c_str());
    list.PushClipRect({place.x, place.y}, {place.x + std::max(place.width, size.x + 4 * edge), place.y + place.height});
    list.AddRectFilled({place.x + edge, place.y + edge}, {place.x + 3 * edge + size.x, place.y + 2 * edge + size.y},
                       IM_COL32(0, 0, 0, 170), edge);
    list.AddText({place.x + 2 * edge, place.y + 1.5f * edge}, IM_COL32(255, 255, 255, 255), text.c_str());
    list.PopClipRect();
}

void Interface::draw_legend(const Place& place) {
    const int width = std::max(160, static_cast<int>(std::min(place.width - 20, 420 * window_.scale())));
    if (legend_width_ != width) {
        const FalseColorOptions options{.scale = legend_scale_,
                                        .caption = std::string(legend_of(difference_shown(view_))),
                                        .letter_size = std::max(1, static_cast<int>(std::lround(window_.scale())))};
        legend_.set(picture_of(color_bar(width, options), {}));
        legend_width_ = width;
    }
    const float x = std::round(place.x + (place.width - static_cast<float>(legend_.width())) / 2);
    const float y = std::round(place.y + place.height - static_cast<float>(legend_.height()) - 8);
    ImGui::GetWindowDrawList()->AddImage(
        drawn(legend_, true), {x, y},
        {x + static_cast<float>(legend_.width()), y + static_cast<float>(legend_.height())});
}

void Interface::handle_mouse(const Place& place) {
    const ImGuiIO& io = ImGui::GetIO();
    const auto columns = static_cast<float>(live_->film().width), rows = static_cast<float>(live_->film().height);
    const DVec2 mouse(io.MousePos.x, io.MousePos.y), moved(io.MouseDelta.x, io.MouseDelta.y);
    const float area_left = ImGui::GetItemRectMin().x, area_width = ImGui::GetItemRectSize().x;
    if (io.MouseWheel != 0) {
        if (io.KeyCtrl) {
            live_->camera.dolly(std::pow(0.9, double(io.MouseWheel)));
        } else {
            // What is under the mouse stays there.
            const DVec2 at((mouse.x - double(place.left)) / double(columns * place.size),
                           (mouse.y - double(place.top)) / double(rows * place.size));
            const float before = zoom_;
            zoom_ = std::clamp(zoom_ * std::pow(1.25f, io.MouseWheel), 0.25f, 1024.0f);
            center_ = at + (center_ - at) * double(before / zoom_);
        }
    }
    for (const int button : {0, 1, 2})
        if (ImGui::IsMouseClicked(button)) {
            drag_ = DVec2(0);
            const double line = double(area_left + split_ * area_width);
            drags_split_ =
                button == 0 && view_ == View::split && std::abs(mouse.x - line) < 8.0 * double(window_.scale());
        }
    const bool left = ImGui::IsMouseDown(0), right = ImGui::IsMouseDown(1), middle = ImGui::IsMouseDown(2);
    if (left || right || middle) drag_ += glm::abs(moved);
    // A click is not a drag.
    const bool drags = glm::length(drag_) > 3.0 * double(window_.scale());
    const double image_width = double(columns * place.size);
    if (drags_split_ && left) {
        split_ = std::clamp(static_cast<float>((mouse.x - double(area_left)) / double(area_width)), 0.0f, 1.0f);
    } else if (drags && moved != DVec2(0)) {
        if (left && io.KeyCtrl) live_->camera.dolly(std::exp(0.005 * moved.y));
        else if (left) live_->camera.orbit(0.006 * moved.x, 0.006 * moved.y);
        else if (right) live_->camera.pan(moved.x / image_width, moved.y / image_width);
        else if (middle) center_ -= moved / DVec2(image_width, double(rows * place.size));
    }
    if (ImGui::IsMouseReleased(0) && !drags && !drags_split_) {
        const int x = static_cast<int>(std::floor((mouse.x - double(place.left)) / double(place.size)));
        const int y = static_cast<int>(std::floor((mouse.y - double(place.top)) / double(place.size)));
        if (x >= 0 && y >= 0 && x < live_->film().width && y < live_->film().height) pick(x, y);
    }
    if (!left) drags_split_ = false;
    if (view_ == View::split &&
        std::abs(mouse.x - double(area_left + split_ * area_width)) < 8.0 * double(window_.scale()))
        ImGui::SetMouseCursor(ImGuiMouseCursor_ResizeEW);
}

}  // namespace lightswitch::program
