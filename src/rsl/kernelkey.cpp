#include "rsl/kernelkey.h"
#include "rsl/jit/sha256.h"
#include "rsl/names.h"
#include "shadeops/descriptor.h"

namespace alpenglow::rsl {

const std::string& descriptorDigest() {
    static const std::string digest = [] {
        std::string all;
        for (const Shadeop& op : allShadeops()) {
            all += op.name + '\1' + char('0' + int(op.lowering)) + char('0' + int(op.derivative)) + char('0' + op.pure) +
                   char('0' + op.outOfLine) + op.rsl + '\1';
            for (const Signature& s : op.signatures) all += s.text + '\2' + s.symbol + '\1';
            for (const OptionalParameter& p : op.optional) all += toString(p.type) + p.name + p.defaultText + '\1';
        }
        return jit::sha256(all);
    }();
    return digest;
}

std::string connectionKey(const Connections& connections) {
    std::string k;
    for (const auto& [to, from] : connections)
        k += '\13' + to.parameter + '\14' + std::to_string(to.element) + '\15' + from.handle + '\16' + from.output +
             (from.member ? "m" : "");
    return k;
}

std::string coShaderKey(const KernelOptions& o) {
    std::string k;
    for (const CoShader& c : o.coShaders) {
        k += '\1' + c.handle + '\2' + c.digest + '\10' + c.space + (c.light ? "l" : "");
        for (const auto& name : c.computed) k += '\7' + name;
        k += connectionKey(c.connections);
        for (const auto& [name, value] : c.strings) k += '\3' + name + '\4' + value;
        for (const auto& [name, value] : c.numbers) {
            k += '\5' + name + '\6';
            k.append(reinterpret_cast<const char*>(value.data()), value.size() * sizeof(float));
        }
    }
    return k;
}

} // namespace alpenglow::rsl
