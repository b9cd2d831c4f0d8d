// Times Embree's single-ray search on a mesh: million rays a second.
//
//     rays MESH.ply RAYS THREADS
//
// MESH.ply is binary, little-endian, of float corners and triangles without other properties; RAYS holds six floats a ray, origin and direction.
// The scene is built for robust searches, as photopic's are. Printed are the rays that hit, the sum of their distances and the rate: the best
// of ten runs over all rays.

#include <embree3/rtcore.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <limits>
#include <string>
#include <thread>
#include <vector>

struct Sum {
    std::size_t hits = 0;
    double distance = 0.0;
};

static void fail(const std::string &what) {
    std::fprintf(stderr, "rays: %s\n", what.c_str());
    std::exit(2);
}

static void load(const char *path, RTCDevice device, RTCScene scene) {
    std::ifstream file(path, std::ios::binary);
    std::string line;
    std::size_t corners = 0, faces = 0;
    while (std::getline(file, line) && line != "end_header") {
        std::sscanf(line.c_str(), "element vertex %zu", &corners);
        std::sscanf(line.c_str(), "element face %zu", &faces);
    }
    if (!file || corners == 0 || faces == 0) fail(std::string(path) + ": no mesh");
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto *positions = static_cast<char *>(
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 12, corners));
    file.read(positions, static_cast<std::streamsize>(12 * corners));
    auto *names = static_cast<std::uint32_t *>(
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 12, faces));
    for (std::size_t face = 0; face < faces; ++face) {
        char record[13];
        if (!file.read(record, 13) || record[0] != 3) fail(std::string(path) + ": expected triangles");
        std::memcpy(names + 3 * face, record + 1, 12);
    }
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene, geometry);
    rtcReleaseGeometry(geometry);
}

static Sum trace(RTCScene scene, const float *rays, std::size_t count) {
    Sum sum;
    for (std::size_t i = 0; i < count; ++i, rays += 6) {
        RTCIntersectContext context;
        rtcInitIntersectContext(&context);
        RTCRayHit ray{};
        ray.ray.org_x = rays[0];
        ray.ray.org_y = rays[1];
        ray.ray.org_z = rays[2];
        ray.ray.dir_x = rays[3];
        ray.ray.dir_y = rays[4];
        ray.ray.dir_z = rays[5];
        ray.ray.tfar = std::numeric_limits<float>::infinity();
        ray.ray.mask = ~0U;
        ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
        rtcIntersect1(scene, &context, &ray);
        if (ray.hit.geomID != RTC_INVALID_GEOMETRY_ID) {
            ++sum.hits;
            sum.distance += ray.ray.tfar;
        }
    }
    return sum;
}

int main(int argc, char **argv) {
    if (argc != 4) fail("expected MESH.ply RAYS THREADS");
    RTCDevice device = rtcNewDevice(nullptr);
    RTCScene scene = rtcNewScene(device);
    rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
    load(argv[1], device, scene);
    rtcCommitScene(scene);
    std::ifstream file(argv[2], std::ios::binary | std::ios::ate);
    if (!file) fail(std::string(argv[2]) + ": cannot be read");
    std::vector<float> rays(static_cast<std::size_t>(file.tellg()) / sizeof(float));
    file.seekg(0);
    file.read(reinterpret_cast<char *>(rays.data()), static_cast<std::streamsize>(rays.size() * sizeof(float)));
    const std::size_t count = rays.size() / 6, threads = std::max(1, std::atoi(argv[3]));
    double best = std::numeric_limits<double>::infinity();
    Sum whole;
    for (int run = 0; run < 10; ++run) {
        std::vector<Sum> sums(threads);
        std::vector<std::thread> workers;
        const auto start = std::chrono::steady_clock::now();
        for (std::size_t n = 0; n < threads; ++n) {
            const std::size_t from = count * n / threads, to = count * (n + 1) / threads;
            workers.emplace_back([&, n, from, to] { sums[n] = trace(scene, rays.data() + 6 * from, to - from); });
        }
        for (auto &worker : workers) worker.join();
        best = std::min(best, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
        whole = Sum{};
        for (const Sum &sum : sums) {
            whole.hits += sum.hits;
            whole.distance += sum.distance;
        }
    }
    std::printf("%zu %.6f %.3f\n", whole.hits, whole.distance, static_cast<double>(count) / best / 1e6);
    rtcReleaseScene(scene);
    rtcReleaseDevice(device);
    return 0;
}
