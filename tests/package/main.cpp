// A program outside of the project: as little as shows that the headers, their dependencies and the targets are found.
#include <lightswitch/version.hpp>

#include <cstdio>

int main() {
    std::printf("lightswitch %s\n", lightswitch::version().c_str());
}
