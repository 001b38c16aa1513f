// Drives editors/vscode/extension.js with a stand-in for VS Code and the real language server.
// node vscode_client.js EXTENSION_FOLDER PROGRAM; status 0 when all is as it should be.
"use strict";
const assert = require("assert");
const fs = require("fs");
const Module = require("module");
const path = require("path");
const [folder, program] = process.argv.slice(2);

const providers = {}, handlers = {}, diagnostics = new Map(), errors = [];
class Position { constructor(line, character) { Object.assign(this, { line, character }); } }
class Range { constructor(start, end) { Object.assign(this, { start, end }); } }
const bag = (...names) => class { constructor(...values) { names.forEach((n, i) => { this[n] = values[i]; }); } };
const text = (content, uri) => ({ uri: { toString: () => uri }, languageId: uri.endsWith(".rib") ? "rib" : "rsl", version: 1, getText: () => content });
const code = "surface a(float Kd = .5;) { Ci = Kd * sqart(s); }\n", uri = "file:///nowhere/a.sl";
const document = text(code, uri), scene = text("WorldBegin\nSpere 1 -1 1 360\nWorldEnd\n", "file:///nowhere/a.rib");
const on = (name) => (f) => { handlers[name] = f; return { dispose() {} }; };
const register = (name) => (selector, provider) => { providers[name] = provider; return { dispose() { delete providers[name]; } }; };
const vscode = {
    Position, Range,
    Location: bag("uri", "range"), Hover: bag("contents", "range"), MarkdownString: bag("value"), Diagnostic: bag("range", "message", "severity"),
    DocumentSymbol: bag("name", "detail", "kind", "range", "selectionRange"), CompletionItem: bag("label", "kind"),
    DocumentHighlight: bag("range", "kind"), TextEdit: bag("range", "newText"), CodeAction: bag("title", "kind"),
    SignatureHelp: bag(), SignatureInformation: bag("label", "documentation"), ParameterInformation: bag("label"),
    SemanticTokens: bag("data"), SemanticTokensLegend: bag("types", "modifiers"), CodeActionKind: { QuickFix: "quickfix" },
    WorkspaceEdit: class { constructor() { this.edits = new Map(); } set(u, e) { this.edits.set(u.toString(), e); } },
    Uri: { parse: (s) => ({ toString: () => s }) },
    window: { showErrorMessage: (m) => errors.push(m) },
    commands: { registerCommand: (name, f) => { handlers[name] = f; return { dispose() {} }; } },
    workspace: {
        getConfiguration: () => ({ get: (k) => (k === "path" ? program : []) }), textDocuments: [document],
        onDidOpenTextDocument: on("open"), onDidChangeTextDocument: on("change"), onDidSaveTextDocument: on("save"), onDidCloseTextDocument: on("close"),
    },
    languages: new Proxy({
        createDiagnosticCollection: () => ({ set: (u, d) => diagnostics.set(u.toString(), d), clear: () => diagnostics.clear(), dispose() {} }),
    }, { get: (known, name) => known[name] || register(name) }),
};
const load = Module._load;
Module._load = (name, ...rest) => (name === "vscode" ? vscode : load(name, ...rest));

async function until(test) {
    for (let i = 0; i < 1000 && !test(); ++i) await new Promise((next) => setTimeout(next, 20));
    assert(test(), "it did not come");
}

async function main() {
    for (const file of ["rsl", "rib"]) {
        const grammar = JSON.parse(fs.readFileSync(path.join(folder, "syntaxes", `${file}.tmLanguage.json`), "utf8"));
        const check = (p) => {
            for (const key of ["match", "begin", "end"]) if (p[key]) new RegExp(p[key]);
            (p.patterns || []).forEach(check);
            Object.values(p.repository || {}).forEach(check);
        };
        check(grammar);
    }
    const extension = require(path.join(folder, JSON.parse(fs.readFileSync(path.join(folder, "package.json"), "utf8")).main));
    await extension.activate({ subscriptions: [] });
    await until(() => diagnostics.get(uri));
    const [d] = diagnostics.get(uri);
    assert(d.message.includes("sqart"), d.message);
    assert.deepStrictEqual([d.severity, d.range.start.line, d.range.start.character], [0, 0, code.indexOf("sqart")]);
    const kd = new Position(0, code.indexOf("Kd *"));
    const hover = await providers.registerHoverProvider.provideHover(document, kd);
    assert(hover.contents.value.includes("float Kd = .5"), hover.contents.value);
    const edit = await providers.registerRenameProvider.provideRenameEdits(document, kd, "diffuseness");
    assert.strictEqual(edit.edits.get(uri).length, 2);
    await assert.rejects(providers.registerRenameProvider.provideRenameEdits(document, kd, "float"), /belongs to the language/);
    const references = await providers.registerReferenceProvider.provideReferences(document, kd, { includeDeclaration: true });
    assert.strictEqual(references.length, 2);
    const [fix] = await providers.registerCodeActionsProvider.provideCodeActions(document, d.range);
    assert.strictEqual(fix.edit.edits.get(uri)[0].newText, "sqrt");
    assert((await providers.registerDocumentSemanticTokensProvider.provideDocumentSemanticTokens(document)).data.length > 0);
    const labels = (await providers.registerCompletionItemProvider.provideCompletionItems(document, new Position(0, code.indexOf("sqart") + 2))).map((i) => i.label);
    assert(labels.includes("sqrt"), labels.join());
    handlers.change({ document, contentChanges: [{ range: new Range(d.range.start, d.range.end), text: "sqrt" }] });
    await until(() => diagnostics.get(uri).length === 0);
    handlers.open(scene);
    await until(() => (diagnostics.get("file:///nowhere/a.rib") || []).length === 1);
    handlers.close(scene);
    await handlers["alpenglow.restart"]();
    await until(() => (diagnostics.get(uri) || []).length === 1); // the text as VS Code has it
    await extension.deactivate();
    assert.deepStrictEqual(errors, []);
}
main().then(() => process.exit(0), (e) => { console.error(e); process.exit(1); });
