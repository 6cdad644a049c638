#include "verify/planted/scenes.hpp"

namespace lightswitch::test {

Estimator library_path(const LibraryDescription& description, const PathTracer& method) {
    return on_library_scene(description, method);
}

Estimator library_nee(const LibraryDescription& description, const PathTracerNee& method) {
    return on_library_scene(description, method);
}

}  // namespace lightswitch::test
