// A client of `alpenglow lsp` that needs nothing but VS Code itself, so that this folder can be used as it is.
"use strict";
const vscode = require("vscode");
const { spawn } = require("child_process");

const LANGUAGES = ["rsl", "rib"];

/// The program, its messages, and the requests that wait for an answer.
class Server {
    constructor(onMessage, onEnd) {
        const settings = vscode.workspace.getConfiguration("alpenglow");
        this.waiting = new Map();
        this.ids = 0;
        this.held = Buffer.alloc(0);
        this.onMessage = onMessage;
        this.process = spawn(settings.get("path"), ["lsp", ...settings.get("arguments")], { stdio: ["pipe", "pipe", "ignore"] });
        this.process.stdout.on("data", (bytes) => this.take(bytes));
        this.process.stdin.on("error", () => {}); // the end is reported below
        this.process.on("error", (e) => this.end(onEnd, e.message));
        this.process.on("exit", (code) => this.end(onEnd, `it ended with status ${code}`));
    }
    end(tell, why) {
        if (this.ended) return;
        this.ended = true;
        for (const { refuse } of this.waiting.values()) refuse(new Error(why));
        this.waiting.clear();
        if (!this.stopping) tell(why);
    }
    take(bytes) {
        this.held = Buffer.concat([this.held, bytes]);
        for (;;) {
            const head = this.held.indexOf("\r\n\r\n");
            if (head < 0) return;
            const length = /Content-Length: *(\d+)/i.exec(this.held.toString("latin1", 0, head));
            const end = head + 4 + (length ? Number(length[1]) : 0);
            if (this.held.length < end) return;
            const text = this.held.toString("utf8", head + 4, end);
            this.held = this.held.subarray(end);
            if (text) this.receive(JSON.parse(text));
        }
    }
    receive(message) {
        const asked = message.method === undefined && this.waiting.get(message.id);
        if (!asked) return this.onMessage(message);
        this.waiting.delete(message.id);
        if (message.error) asked.refuse(new Error(message.error.message));
        else asked.fulfil(message.result);
    }
    send(message) {
        if (this.ended) return;
        const body = Buffer.from(JSON.stringify({ jsonrpc: "2.0", ...message }), "utf8");
        this.process.stdin.write(`Content-Length: ${body.length}\r\n\r\n`);
        this.process.stdin.write(body);
    }
    notify(method, params) { this.send({ method, params }); }
    request(method, params) {
        if (this.ended) return Promise.resolve(null);
        const id = ++this.ids;
        return new Promise((fulfil, refuse) => {
            this.waiting.set(id, { fulfil, refuse });
            this.send({ id, method, params });
        });
    }
    async stop() {
        this.stopping = true;
        try { await this.request("shutdown", null); } catch { /* it has ended */ }
        this.notify("exit", null);
    }
}

const toPosition = (p) => new vscode.Position(p.line, p.character);
const toRange = (r) => new vscode.Range(toPosition(r.start), toPosition(r.end));
const toLocation = (l) => new vscode.Location(vscode.Uri.parse(l.uri), toRange(l.range));
const fromPosition = (p) => ({ line: p.line, character: p.character });
const fromRange = (r) => ({ start: fromPosition(r.start), end: fromPosition(r.end) });
const place = (document, position) => ({ textDocument: { uri: document.uri.toString() }, position: fromPosition(position) });
const markdown = (c) => (c === undefined ? undefined : typeof c === "string" ? c : new vscode.MarkdownString(c.value));
const toEdit = (e) => new vscode.TextEdit(toRange(e.range), e.newText);

function toWorkspaceEdit(edit) {
    const all = new vscode.WorkspaceEdit();
    for (const [uri, edits] of Object.entries(edit.changes)) all.set(vscode.Uri.parse(uri), edits.map(toEdit));
    return all;
}

function toDiagnostic(d) {
    const made = new vscode.Diagnostic(toRange(d.range), d.message, d.severity - 1);
    made.source = d.source;
    made.code = d.code;
    made.tags = d.tags;
    return made;
}

function toSymbol(s) {
    const made = new vscode.DocumentSymbol(s.name, s.detail || "", s.kind - 1, toRange(s.range), toRange(s.selectionRange));
    made.children = (s.children || []).map(toSymbol);
    return made;
}

function toCompletion(i) {
    const made = new vscode.CompletionItem(i.label, i.kind - 1);
    made.detail = i.detail;
    made.documentation = markdown(i.documentation);
    return made;
}

/// What VS Code asks, by what the server answers.
function providers(ask) {
    return {
        hover: { provideHover: async (d, p) => {
            const h = await ask("textDocument/hover", place(d, p));
            return h && new vscode.Hover(markdown(h.contents), toRange(h.range));
        } },
        completion: { provideCompletionItems: async (d, p) => (await ask("textDocument/completion", place(d, p)) || []).map(toCompletion) },
        definition: { provideDefinition: async (d, p) => {
            const l = await ask("textDocument/definition", place(d, p));
            return l && (Array.isArray(l) ? l.map(toLocation) : toLocation(l));
        } },
        references: { provideReferences: async (d, p, context) =>
            (await ask("textDocument/references", { ...place(d, p), context }) || []).map(toLocation) },
        highlights: { provideDocumentHighlights: async (d, p) =>
            (await ask("textDocument/documentHighlight", place(d, p)) || [])
                .map((h) => new vscode.DocumentHighlight(toRange(h.range), h.kind - 1)) },
        rename: {
            prepareRename: async (d, p) => {
                const r = await ask("textDocument/prepareRename", place(d, p), true);
                if (!r) throw new Error("There is no name here.");
                return { range: toRange(r.range), placeholder: r.placeholder };
            },
            provideRenameEdits: async (d, p, newName) =>
                toWorkspaceEdit(await ask("textDocument/rename", { ...place(d, p), newName }, true)),
        },
        symbols: { provideDocumentSymbols: async (d) =>
            (await ask("textDocument/documentSymbol", { textDocument: { uri: d.uri.toString() } }) || []).map(toSymbol) },
        formatting: { provideDocumentFormattingEdits: async (d, options) =>
            (await ask("textDocument/formatting", {
                textDocument: { uri: d.uri.toString() },
                options: { tabSize: options.tabSize, insertSpaces: options.insertSpaces },
            }) || []).map(toEdit) },
        actions: { provideCodeActions: async (d, range) =>
            (await ask("textDocument/codeAction", {
                textDocument: { uri: d.uri.toString() }, range: fromRange(range), context: { diagnostics: [] },
            }) || []).map((a) => {
                const made = new vscode.CodeAction(a.title, vscode.CodeActionKind.QuickFix);
                made.edit = toWorkspaceEdit(a.edit);
                return made;
            }) },
        signatures: { provideSignatureHelp: async (d, p) => {
            const h = await ask("textDocument/signatureHelp", place(d, p));
            if (!h) return null;
            const made = new vscode.SignatureHelp();
            made.signatures = h.signatures.map((s) => {
                const one = new vscode.SignatureInformation(s.label, markdown(s.documentation));
                one.parameters = s.parameters.map((q) => new vscode.ParameterInformation(q.label));
                return one;
            });
            made.activeSignature = h.activeSignature;
            made.activeParameter = h.activeParameter;
            return made;
        } },
        tokens: { provideDocumentSemanticTokens: async (d) => {
            const t = await ask("textDocument/semanticTokens/full", { textDocument: { uri: d.uri.toString() } });
            return t && new vscode.SemanticTokens(new Uint32Array(t.data));
        } },
    };
}

class Client {
    constructor() {
        this.diagnostics = vscode.languages.createDiagnosticCollection("alpenglow");
        this.registrations = [];
    }
    /// Failures are no news to who types; a rename wants the reason.
    ask(method, params, aloud = false) {
        const answer = this.server.request(method, params);
        return aloud ? answer : answer.catch(() => null);
    }
    async start() {
        this.server = new Server((m) => this.receive(m), (why) =>
            vscode.window.showErrorMessage(`Alpenglow's language server does not run (${why}). Is "alpenglow.path" right in the settings?`));
        const server = this.server;
        const begun = await server.request("initialize", { processId: process.pid, rootUri: null, capabilities: {} }).catch(() => null);
        if (!begun || server !== this.server) return;
        server.notify("initialized", {});
        for (const d of vscode.workspace.textDocuments) this.open(d);
        const p = providers((method, params, aloud) => this.ask(method, params, aloud));
        const l = vscode.languages, legend = begun.capabilities.semanticTokensProvider.legend;
        const selector = LANGUAGES.map((language) => ({ language }));
        this.registrations = [
            l.registerHoverProvider(selector, p.hover), l.registerCompletionItemProvider(selector, p.completion, "\"", ">", "."),
            l.registerDefinitionProvider(selector, p.definition), l.registerReferenceProvider(selector, p.references),
            l.registerDocumentHighlightProvider(selector, p.highlights), l.registerRenameProvider(selector, p.rename),
            l.registerDocumentSymbolProvider(selector, p.symbols),
            l.registerDocumentFormattingEditProvider({ language: "rsl" }, p.formatting),
            l.registerCodeActionsProvider(selector, p.actions), l.registerSignatureHelpProvider(selector, p.signatures, "(", ","),
            l.registerDocumentSemanticTokensProvider({ language: "rsl" }, p.tokens,
                new vscode.SemanticTokensLegend(legend.tokenTypes, legend.tokenModifiers)),
        ];
    }
    receive(m) {
        if (m.method !== "textDocument/publishDiagnostics") return;
        this.diagnostics.set(vscode.Uri.parse(m.params.uri), m.params.diagnostics.map(toDiagnostic));
    }
    open(d) {
        if (!LANGUAGES.includes(d.languageId)) return;
        this.server.notify("textDocument/didOpen", { textDocument: {
            uri: d.uri.toString(), languageId: d.languageId, version: d.version, text: d.getText() } });
    }
    change(e) {
        if (!LANGUAGES.includes(e.document.languageId) || e.contentChanges.length === 0) return;
        this.server.notify("textDocument/didChange", {
            textDocument: { uri: e.document.uri.toString(), version: e.document.version },
            contentChanges: e.contentChanges.map((c) => ({ range: fromRange(c.range), text: c.text })) });
    }
    tell(what, d) {
        if (LANGUAGES.includes(d.languageId)) this.server.notify(`textDocument/${what}`, { textDocument: { uri: d.uri.toString() } });
    }
    async stop() {
        for (const r of this.registrations) r.dispose();
        this.registrations = [];
        this.diagnostics.clear();
        await this.server.stop();
    }
}

let client;
exports.activate = async (context) => {
    client = new Client();
    const w = vscode.workspace;
    context.subscriptions.push(
        client.diagnostics,
        w.onDidOpenTextDocument((d) => client.open(d)), w.onDidChangeTextDocument((e) => client.change(e)),
        w.onDidSaveTextDocument((d) => client.tell("didSave", d)), w.onDidCloseTextDocument((d) => client.tell("didClose", d)),
        vscode.commands.registerCommand("alpenglow.restart", async () => { await client.stop(); await client.start(); }));
    await client.start();
};
exports.deactivate = () => client && client.stop();
