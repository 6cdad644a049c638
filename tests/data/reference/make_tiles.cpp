// Reduces two independent halves of a reference image to the tile data that the tests read; see README.md beside this
// file.
//
//   make_tiles A.pfm B.pfm [TILE] > NAME.txt    for tiles of TILE pixels a side (16); prints a check of the reference's
//   own
//                                               error to standard error

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace {

struct Pfm {
    int width = 0, height = 0;
    std::vector<float> values;  // bottom row first, as in the file

    explicit Pfm(const std::string& path) {
        std::ifstream file(path, std::ios::binary);
        std::string magic;
        double scale = 0;
        file >> magic >> width >> height >> scale;
        file.get();
        if (magic != "PF" || !(scale < 0)) throw std::runtime_error(path + " is not a little-endian colour PFM");
        values.resize(static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * 3);
        file.read(reinterpret_cast<char*>(values.data()), static_cast<std::streamsize>(values.size() * sizeof(float)));
        if (!file) throw std::runtime_error(path + " is too short");
    }

    /// Row 0 at the top.
    double at(int x, int y, int channel) const {
        return values[static_cast<std::size_t>(((height - 1 - y) * width + x) * 3 + channel)];
    }
};

}  // namespace

int main(int argc, char** argv) {
    if (argc != 3 && argc != 4) return std::fprintf(stderr, "usage: make_tiles A.pfm B.pfm [TILE] > NAME.txt\n"), 2;
    const int tile = argc == 4 ? std::atoi(argv[3]) : 16;
    const Pfm a(argv[1]), b(argv[2]);
    std::printf("%d %d %d\n", a.width / tile, a.height / tile, tile);
    double ratio = 0, count = 0;
    for (int y0 = 0; y0 < a.height; y0 += tile)
        for (int x0 = 0; x0 < a.width; x0 += tile) {
            double mean[3] = {}, variance[3] = {};
            for (int c = 0; c < 3; ++c) {
                double difference = 0;
                for (int y = y0; y < y0 + tile; ++y)
                    for (int x = x0; x < x0 + tile; ++x) {
                        const double d = a.at(x, y, c) - b.at(x, y, c);
                        mean[c] += (a.at(x, y, c) + b.at(x, y, c)) / 2;
                        // (a + b) / 2 has a quarter of the variance of a - b.
                        variance[c] += d * d / 4;
                        difference += d;
                    }
                const double pixels = double(tile) * tile;
                mean[c] /= pixels;
                variance[c] /= pixels * pixels;
                if (variance[c] > 0) {
                    ratio += difference * difference / (4 * pixels * pixels) / variance[c];
                    ++count;
                }
            }
            std::printf("%.9g %.9g %.9g %.4g %.4g %.4g\n", mean[0], mean[1], mean[2], variance[0], variance[1],
                        variance[2]);
        }
    std::fprintf(stderr,
                 "squared difference of the halves, tiles over pixels: %.3f (1 when pixels err independently)\n",
                 ratio / count);
}
