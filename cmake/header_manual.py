#!/usr/bin/env python3
"""Manual pages made of the public header's comments: hrt(3) and kenaf.toml(5), and for each function a link to hrt(3).

    header_manual.py HEADER USER_GUIDE VERSION OUT_DIR

Writes OUT_DIR/man3/hrt.3, OUT_DIR/man3/FUNCTION.3 and OUT_DIR/man5/kenaf.toml.5. The user guide has the example of a
kenaf.toml. Whatever of the header this does not understand is an error: a page that lacks something would not show it.
"""
import pathlib
import re
import sys
import textwrap


LAYOUT = ".nr HY 0\n.nh\n.ad l\n"  # names of functions and keys are not parted at line ends


def troff(text):
    """Text as troff takes it literally."""
    text = text.replace("\\", "\\e").replace("-", "\\-")
    return re.sub(r"(?m)^([.'])", r"\\&\1", text)


def one_line(text):
    return re.sub(r"\s+", " ", text).strip()


def code(text):
    return ".EX\n" + troff(text.rstrip("\n")) + "\n.EE\n"


def bare(comment):
    """A comment's text without its signs, with its indentation."""
    lines = comment.strip().removeprefix("/*").removesuffix("*/").split("\n")
    return "\n".join([lines[0].strip()] + [re.sub(r"^ ?\* ?", "", line.strip()) for line in lines[1:]]).rstrip()


def prose(text):
    """Paragraphs and indented examples of a comment; a line with a hanging dash or number begins one of its own."""
    out = []
    for block in re.split(r"\n[ \t]*\n", text):
        lines = block.split("\n")
        if all(line.startswith("    ") for line in lines if line):
            out.append(".PP\n.RS 4\n" + code(textwrap.dedent(block)) + ".RE\n")
            continue
        out.append(".PP\n")
        in_list = False
        arguments = bool(re.match(r"[a-z]\w* {2,}", lines[0]))
        for line in lines:
            item = re.match(r"\s*(-|\d\.|[a-z]\w*(?= {2,}))\s+(.*)", line) or (
                re.match(r"([a-z]\w*_\w*) (.*)", line) if arguments else None)
            if item:
                out.append(f".TP 4\n{troff(item[1])}\n{troff(item[2])}\n")
                in_list = True
            elif in_list and line == line.lstrip():
                out.append(f".PP\n{troff(line)}\n")
                in_list = False
            elif re.match(r"HRT_\w+:", line):
                out.append(f".br\n{troff(line)}\n")
            else:
                out.append(troff(line.strip()) + "\n")
    return "".join(out)


def heading(text):
    return ".SH " + troff(text.upper()) + "\n"


def titled_paragraphs(text):
    """The header's first comment: lines without indentation that stand alone are titles of what is indented below."""
    out, part = [], []

    def flush():
        if part:
            out.append(prose(textwrap.dedent("\n".join(part)).strip("\n")))
            part.clear()

    lines = text.split("\n")
    for i, line in enumerate(lines):
        is_title = re.fullmatch(r"[A-Z][a-z ]+", line) and i + 1 < len(lines) and lines[i + 1].startswith("  ")
        if is_title:
            flush()
            out.append(".SS " + line + "\n")
        else:
            part.append(line)
    flush()
    return "".join(out)


INLINE = r"(?:static \w*inline\w*|[A-Z]+_INLINE)"  # how a function that the header defines begins


def parts_of(header):
    """The header from its first declaration on, as comments and declarations in their order."""
    start = header.index("/* The binary interface described")
    end = header.rindex("#if defined(__GNUC__)")
    rest = header[start:end]
    pattern = re.compile(
        r"\s*(?:(?P<comment>/\*.*?\*/)(?=\s)|(?P<macro>#define[^\n]*)|(?P<conditional>#if.*?\n#endif[^\n]*)"
        rf"|(?P<block>(?:typedef struct|enum|{INLINE})\b[^;{{]*\{{.*?\n?\}}[^;\n]*;?(?=\n))"
        r"|(?P<function>[a-z][^;{}]*\([^;{}]*\);))", re.S)
    position = 0
    while rest[position:].strip():
        match = pattern.match(rest, position)
        if not match:
            sys.exit(f"header_manual: hrt.h: not understood: {rest[position:].strip().splitlines()[0]}")
        yield match.lastgroup, match[match.lastgroup]
        position = match.end()


def prototype_of(inline_function):
    return re.sub(rf"^{INLINE} |\s*\{{.*", "", inline_function, flags=re.S) + ";"


def name_of(prototype):
    return re.search(r"(\w+)\(", prototype)[1]


def sections_of(header):
    """Comments with the declarations that follow them: (comment, [declarations])."""
    sections = []
    for kind, text in parts_of(header):
        if kind == "comment":
            sections.append((bare(text), []))
        elif kind == "conditional":  # with the comment before it: what compilers need, and no reader
            if not sections[-1][1]:
                sections.pop()
        else:
            sections[-1][1].append((kind, text))
    return sections


def hrt_page(header, version):
    sections = sections_of(header)
    inline = [prototype_of(text) for _, declared in sections for kind, text in declared
              if kind == "block" and re.match(INLINE, text)]
    functions = [text for _, declared in sections for kind, text in declared if kind == "function"] + inline
    intro = bare(header[: header.index("*/") + 2])
    title, intro = intro.split("\n", 1)
    out = [f'.TH HRT 3 "" "Kenaf {version}" "Library functions"\n', LAYOUT,
           ".SH NAME\nhrt \\- control of the Kenaf robot, or of its simulation\n",
           ".SH SYNOPSIS\n.nf\n.B #include <kenaf/hrt.h>\n.sp\n",
           troff("cc PROGRAM.c $(pkg-config --cflags --libs kenaf-sim)     # its simulation\n"
                 "cc PROGRAM.c $(pkg-config --cflags --libs kenaf-real)    # the robot\n"), ".sp\n",
           "".join(troff(one_line(function)) + "\n" for function in functions), ".fi\n",
           ".SH DESCRIPTION\n", troff(title.split(" - ", 1)[1][0].upper() + title.split(" - ", 1)[1][1:]) + "\n",
           titled_paragraphs(intro)]
    for comment, declared in sections:
        section = re.match(r"---- (.*?) ----\s*(.*)", comment, re.S)
        if section:
            out.append(heading(section[1]))
            comment = section[2]
        protos = [prototype_of(t) if re.match(INLINE, t) else t for _, t in declared
                  if re.match(INLINE, t) or not re.match(r"#|enum|typedef", t)]
        types = [t for _, t in declared if re.match(r"#|enum|typedef", t)]
        if protos:
            out.append(".PP\n" + "".join(f".B {troff(one_line(p))}\n.br\n" for p in protos))
            out.append(".RS 4\n" + prose(comment).removeprefix(".PP\n") + ".RE\n")
        elif comment:
            out.append(prose(comment))
        for text in types:
            out.append(".PP\n" + code(text))
    out.append(".SH ENVIRONMENT\n.TP\n.BR KENAF_CONFIG \", \" KENAF_ \\fIKEY\\fR\n"
               "The configuration; see\n.BR kenaf.toml (5).\n"
               ".TP\n.B KENAF_DATA_DIR\nA folder with\n.IR robots/ ,\nsearched before the shipped one.\n")
    out.append(".SH EXAMPLES\nThe program at the head of this page, and those in\n"
               ".IR /usr/share/doc/kenaf/examples .\n")
    out.append(".SH SEE ALSO\n.BR kenaf.toml (5),\n.BR kenaf\\-relayd (1),\n.BR kenaf\\-world (1),\n"
               ".BR kenaf\\-draw (1)\n.PP\nThe user guide,\n.IR /usr/share/doc/kenaf/docs/user\\-guide.md .\n")
    return "".join(out), [name_of(function) for function in functions]


def config_page(header, guide, version):
    struct = re.search(r"typedef struct hrt_config \{\n(.*?)\n\} hrt_config;", header, re.S)[1]
    sources = bare(re.search(r"/\* ---- Configuration ----.*?\*/", header, re.S)[0])
    sources = sources.split("\n", 1)[1].strip("\n").replace("the member names below", "those below").replace(
        "the member's name", "the key").replace("uses its own", "uses those that it needs")
    example = re.search(r"```toml\n(# kenaf.toml\n.*?)```", guide, re.S)
    if not example:
        sys.exit("header_manual: the user guide has no example that begins with # kenaf.toml")
    out = [f'.TH KENAF.TOML 5 "" "Kenaf {version}" "File formats"\n', LAYOUT,
           ".SH NAME\nkenaf.toml \\- configuration of programs that drive the Kenaf robot or its simulation\n",
           ".SH DESCRIPTION\nA TOML file that\n.B hrt_kenaf_init()\nreads; see\n.BR hrt (3).\n",
           prose(sources), ".SH KEYS\n"]
    member = re.compile(r"\s*(?:/\* (?P<group>[^*]*?)\.? \*/\n"
                        r"|(?P<type>double|int32_t|char|uint32_t) (?P<name>\w+)(?P<size>\[\d+\])?;\s*/\*(?P<text>.*?)\*/)",
                        re.S)
    position = 0
    kinds = {"double": "number", "int32_t": "true or false", "char": "text"}
    while struct[position:].strip():
        match = member.match(struct, position)
        if not match:
            sys.exit(f"header_manual: hrt_config: not understood: {struct[position:].strip().splitlines()[0]}")
        position = match.end()
        if match["group"]:
            out.append(".SS " + troff(one_line(match["group"])) + "\n")
        elif match["type"] in kinds:  # the others make the struct safe to pass
            out.append(f".TP\n.BR {troff(match['name'])} \" ({kinds[match['type']]})\"\n"
                       f"{troff(one_line(match['text']))}\n")
    out += [".SH ENVIRONMENT\n.TP\n.B KENAF_CONFIG\nThe file to read instead of those below.\n",
            ".TP\n.BR KENAF_ \\fIKEY\\fR\nOverrides a key of the file:\n.B KENAF_RELAY\noverrides\n.BR relay .\n",
            ".SH FILES\n.TP\n.I ./kenaf.toml\nIn the folder where the program is started.\n",
            ".TP\n.I ~/.config/kenaf/kenaf.toml\nWhere there is none.\n",
            ".SH EXAMPLES\n", code(example[1]),
            ".SH SEE ALSO\n.BR hrt (3),\n.BR kenaf\\-relayd (1)\n"]
    return "".join(out)


def main():
    header_file, guide_file, version, out_dir = sys.argv[1:]
    header = pathlib.Path(header_file).read_text(encoding="utf-8")
    guide = pathlib.Path(guide_file).read_text(encoding="utf-8")
    out = pathlib.Path(out_dir)
    for folder in ("man3", "man5"):
        (out / folder).mkdir(parents=True, exist_ok=True)
    page, functions = hrt_page(header, version)
    (out / "man3" / "hrt.3").write_text(page, encoding="utf-8")
    for function in functions:
        link = out / "man3" / f"{function}.3"
        link.unlink(missing_ok=True)
        link.symlink_to("hrt.3")
    (out / "man5" / "kenaf.toml.5").write_text(config_page(header, guide, version), encoding="utf-8")


main()
