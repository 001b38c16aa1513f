// Keeps the requests that calls of C become.
#pragma once
#include "ri/c/client.h"
#include <vector>

namespace alpenglow::ri {

class Recorder : public Target {
public:
    Recorder() { Client::setOfProcess(&client_); }
    ~Recorder() override { Client::setOfProcess(nullptr); }
    void execute(const Call& c) override {
        (void)sketch.note(c);
        calls.push_back(c);
    }
    Reporter& reporter() override { return reporter_; }
    const Declarations& declarations() const override { return sketch.declarations; }
    int colorSamples() const override { return sketch.colorSamples; }
    scene::AttributesRef attributes() override { return sketch.attributes; }
    int nextHandle() override { return ++serial; }
    std::optional<Matrix> between(const std::string&, const std::string&) override { return {}; }
    void subdivide(const std::function<void(float)>& make, const std::vector<float>&, const Call& by) override {
        subdivideHere(*this, make, by);
    }
    void readArchive(const Call& c, const Lexer::Comments&) override { execute(c); }
    void record(const std::string&, const std::string&, const Call& by) override { execute(by); }
    std::string said() const {
        std::string all;
        for (const Diagnostic& d : diags_.all()) all += toString(d);
        return all;
    }

    std::vector<Call> calls;
    Sketch sketch;
    int serial = 0;

private:
    std::string nameOf(int n) const override { return std::to_string(n); }
    Diagnostics diags_;
    Reporter reporter_{diags_};
    Client client_{*this, {"call", 0, 0}, ""};
};

} // namespace alpenglow::ri
