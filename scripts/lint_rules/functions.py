"""Finds the functions of a C++ file by its braces: a lexer, not a parser. It knows comments, strings, raw strings, directives."""
import re

TOKEN = re.compile(
    r"""(?P<space>\s+)|(?P<comment>//(?:\\\n|[^\n])*|/\*.*?\*/)
    |(?P<raw>(?:u8|[uUL])?R"(?P<mark>[^()\s\\]{0,16})\(.*?\)(?P=mark)")
    |(?P<string>(?:u8|[uUL])?"(?:\\.|[^"\\\n])*")
    |(?P<number>\.?\d(?:'?[\w.]|(?<=[eEpP])[+-])*)
    |(?P<char>(?:u8|[uUL])?'(?:\\.|[^'\\\n])*')
    |(?P<word>[A-Za-z_]\w*)
    |(?P<mark2>::|->|&&|\|\||[<>=!+*/%&|^-]=|<<|.)""",
    re.S | re.X)
DIRECTIVE = re.compile(r"[ \t]*#[ \t]*(\w*)(?:\\\n|/\*.*?\*/|[^\n])*", re.S)
TYPES = {"class", "struct", "union", "enum"}
TAKES_BRACKETS = {"decltype", "noexcept", "alignas", "__attribute__", "requires", "explicit"}
ACCESS = {"public", "private", "protected"}


def tokens(text):
    """(text, line) of each token; directives as ("#name", line)."""
    at, line, start_of_line = 0, 1, True
    while at < len(text):
        if start_of_line and (m := DIRECTIVE.match(text, at)):
            yield "#" + m.group(1), line
        else:
            m = TOKEN.match(text, at)
            if m.lastgroup == "word" or m.lastgroup in ("number", "mark2"):
                yield m.group(), line
            elif m.lastgroup in ("string", "raw", "char", "mark"):
                yield '""', line
        piece = m.group()
        line += piece.count("\n")
        start_of_line = not piece.strip() and (start_of_line or "\n" in piece)
        at = m.end()


def matching(head, opening):
    """The index behind the bracket that closes head[opening]."""
    depth = 0
    for i in range(opening, len(head)):
        depth += (head[i][0] in ("(", "[")) - (head[i][0] in (")", "]"))
        if depth == 0:
            return i + 1
    return len(head)


def unclosed(head):
    """Whether a bracket of arguments is open."""
    return sum((t == "(") - (t == ")") for t, _ in head) > 0


def behind_arguments(words, i):
    """The index behind the > that closes the < at i."""
    depth = 0
    while i < len(words):
        depth += (words[i] == "<") - (words[i] == ">")
        i += 1
        if depth == 0:
            break
    return i


def without_template(words):
    """Index of the first token behind `template <...>` prefixes."""
    i = 0
    while i < len(words) and words[i] == "template":
        i = behind_arguments(words, i + 1)
    return i


def classify(head):
    """What the brace behind these tokens opens: (kind, name). Kinds: scope (namespace, type), function, data."""
    words = [t for t, _ in head]
    start = without_template(words)
    if words[start:start + 1] and words[start] in TYPES and words[-1] not in (")", "const", "noexcept"):
        return "scope", ""
    opening = None  # the first bracket of parameters
    i = start
    while i < len(words):
        if words[i] == "namespace":
            return "scope", ""
        if words[i] == "[":
            i = matching(head, i)
            continue
        if words[i] == "<":
            i = behind_arguments(words, i)
            continue
        if words[i] in TAKES_BRACKETS and words[i + 1:i + 2] == ["("]:
            i = matching(head, i + 1)
            continue
        if words[i] == "operator":
            i += 1
            while i < len(words) and words[i] != "(":
                i += 1
            if words[i + 1:i + 2] == [")"]:
                i += 2
            opening = i if i < len(words) else None
            break
        if words[i] == "=":
            # A lambda that a variable is made of counts; lists of values do not.
            lambda_at = next((k for k in range(i, len(words)) if words[k] == "["), None)
            if lambda_at is None or words[-1] not in (")", "mutable", "noexcept") and "->" not in words[lambda_at:]:
                return "data", ""
            return "function", words[i - 1]
        if words[i] == "(":
            opening = i
            break
        i += 1
    if opening is None:
        return ("scope", "") if TYPES & set(words[start:]) or words[:1] == ["extern"] else ("data", "")
    behind = matching(head, opening)
    if words[behind:behind + 1] == [":"] and words[-1] not in (")", "}"):
        return "data", ""  # a member initialised with braces
    name = opening
    while name > start and (words[name - 1] == "::" or words[name - 1] == "~" or words[name - 1] == "operator" or
                            re.match(r"\w", words[name - 1]) and (name == opening or words[name] in ("::", "~")) or
                            "operator" in words[start:name] and name > words.index("operator")):
        name -= 1
    text = "".join(words[name:opening])
    if not text:
        return "data", ""  # std::function<void()> f = [] { ... }
    if re.fullmatch(r"(TYPED_)?TEST(_[FP])?|(RC_|BENCHMARK_)\w+", text):
        text += "(" + ",".join(w for w in words[opening + 1:behind - 1] if w != ",") + ")"
    return "function", text


def find(text):
    """(name, first line, last line) of each function definition, in order."""
    found, scopes, saved = [], [], []
    head = []  # tokens since the last statement, in a namespace or type
    depth = 0  # braces open within a function or data
    current = None
    for token, line in tokens(text):
        if token.startswith("#"):
            if token.startswith("#if"):
                saved.append((list(scopes), list(head), depth, current))
            elif token in ("#else", "#elif") and saved:
                scopes, head, depth, current = list(saved[-1][0]), list(saved[-1][1]), saved[-1][2], saved[-1][3]
            elif token == "#endif" and saved:
                saved.pop()
        elif depth:
            depth += (token == "{") - (token == "}")
            if depth == 0 and current is not None:
                if current:
                    found.append((*current, line))
                    head = []
                else:
                    head.append((token, line))  # data: the statement goes on to its semicolon
                current = None
        elif token == "{":
            kind, name = ("data", "") if unclosed(head) else classify(head)
            if kind == "scope":
                scopes.append(kind)
                head = []
            else:
                depth = 1
                current = (name, head[0][1]) if kind == "function" else ()
        elif token == "}":
            if scopes:
                scopes.pop()
            head = []
        elif token == ";" and not unclosed(head):
            head = []
        elif token == ":" and head and head[-1][0] in ACCESS and len(head) == 1:
            head = []
        else:
            head.append((token, line))
    return found
