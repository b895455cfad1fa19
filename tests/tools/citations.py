# SPDX-License-Identifier: GPL-3.0-or-later
"""Holds what the source cites against the manual pages of section 7. usage: citations.py ROOT; prints what is cited
but not defined, one a line, and fails if there is any.

[physics §n] and [devices §n] are numbered sections, [devices guarantee n] a guarantee, [formats: heading] a heading,
[RAY21 eq 8] a paper under REFERENCES of vam-physics.7 and an equation that stands in that page; figures, sections and
the like stand in the paper's entry. Whatever is in brackets and begins like one of these must be one, and nothing of
the kind is cited in another form. vam:name is an attribute of vam-formats.7. Keys of the printer file, schemas of
reports and every literal key of the JSON that the tools write are defined in vam-formats.7. Every equation that the
pages take from a paper is cited somewhere in lib, every paper of the references is cited, and comments cite papers in
no other form. Sections of these pages that pages name exist. Source paths in these pages and in CONTRIBUTING.md exist, and source files that comments name; the
changes that its recipes show apply, and its diagram has every folder of lib/layers.txt."""
import pathlib
import re
import sys

root = pathlib.Path(sys.argv[1])
KEY = r'[A-Z]{2,6}\d\d'


def page(name):
    path = root / f'man/vam-{name}.7'
    return path.read_text() if path.exists() else ''


def headings(text):
    return {m.strip().strip('"').lower() for m in re.findall(r'^\.S[hs] (.*)', text, re.M)}


def joined(text):
    """The text with comments that run over lines joined."""
    return re.sub(r'\n\s*(?:///?|#)\s?', ' ', text)


def brackets(text):
    """The contents of brackets that begin as a citation does; in comments of C++ any capitals are a paper's key."""
    begin = rf'(?<!\w)\[((?:physics|devices|formats|{KEY})\b[^\[\]]*)\]'
    capitals = r'(?<![\w\]])\[([A-Z]{2,}\d*(?:[ ,;][^\[\]]*)?)\]'
    comments = re.findall(r'(?:^[ \t]*//.*\n)+|//.*', text, re.M)
    found = [b for c in comments for b in re.findall(capitals, joined(c))]
    return [' '.join(b.split()) for b in found + re.findall(begin, joined(text))]


NUMBER = r'S?\d+(?:\.\d+)*'
PART = rf'{NUMBER}(?:[a-zA-Z](?:-[a-z])?)?(?:(?:, | )[a-z]\b)*'  # of a figure: 2b-d
PLACE = (rf'(?:below )?eq {NUMBER}(?:-{NUMBER})?|'
         rf'(?P<kind>figs?|sections?|appendix|chapter|formula) (?P<numbers>{PART}(?:(?:, | and ){PART})*)')
PAPER = rf'(?P<key>[A-Z]+\d*)(?: (?:{PLACE}|Methods|"[^"]*"))?(?:[,:] (?P<words>[a-zA-Z"].*))?'
FORMS = [r'(?P<page>physics|devices) (?P<sections>§\d+(?:\.\d+)?(?:, §\d+(?:\.\d+)?)*)',
         r'devices (?P<guarantees>guarantee \d+|guarantees \d+(?:, \d+)* and \d+)', r'formats: (?P<heading>.+)', PAPER]


def mistakes(bracket):
    """What is wrong with a citation: parts that are of none of the forms, or name what the pages do not define."""
    for part in re.split(rf'; |, (?={KEY}|physics|devices|formats)', bracket):
        form = next(filter(None, (re.fullmatch(f, part) for f in FORMS)), None)
        of = form.groupdict() if form else {}
        words = of.get('words') or ''
        if not form or re.search(r'\b(eqs?|figs?|sections?|appendix) \S*\d', words):
            yield f'[{bracket}] is no form of citation'
        for number in re.findall(r'[\d.]+', of.get('sections') or ''):
            if number not in sections[of['page']]:
                yield f'vam-{of["page"]}(7) has no section {number}'
        for number in re.findall(r'\d+', of.get('guarantees') or ''):
            if not 1 <= int(number) <= guarantees:
                yield f'vam-devices(7) has no guarantee {number}'
        if (heading := of.get('heading')) and heading.lower() not in headings(formats):
            yield f'vam-formats(7) has no heading "{heading}"'
        if (key := of.get('key')) and key not in papers:
            yield f'[{key}] is not among the references of vam-physics(7)'
        elif key and of['kind']:
            places = set(re.findall(NUMBER, ' '.join(re.findall(rf'{of["kind"][:3]}\w* ([S\d., and]+)', papers[key]))))
            yield from (f'[{key} {of["kind"]} {n}] does not stand in the references of vam-physics(7)'
                        for n in re.findall(NUMBER, of['numbers']) if n not in places)
    yield from (f'[{e}] does not stand in vam-physics(7)' for e in sorted(equations(bracket) - defined))


def equations(bracket):
    """{'RAY21 eq 4', ...}: the equations that it names, ranges counted out."""
    found = set()
    for key, numbers in re.findall(rf'({KEY}) (?:below )?eq ([S\d]+(?:-[S\d]+)?)', bracket):
        letter = 'S' if numbers.startswith('S') else ''
        ends = [int(n.strip('S')) for n in numbers.split('-')]
        found |= {f'{key} eq {letter}{n}' for n in range(ends[0], ends[-1] + 1)}
    return found


def within(text, start):
    """The text in the braces that open at start, and its elements."""
    depth, first, elements, i = 0, start + 1, [], start
    while i < len(text):
        if text[i] == '"':
            i = re.compile(r'(?:[^"\\]|\\.)*"').match(text, i + 1).end() - 1
        depth += (text[i] in '{([') - (text[i] in '})]')
        if depth == 0 or (depth == 1 and text[i] == ','):
            elements.append(text[first:i].strip())
            first = i + 1
        if depth == 0:
            break
        i += 1
    return elements


def json_keys(text):
    """Literal keys of the objects that C++ makes: {{"key", value}, ...}, json["key"] = value, and a scan's values. What
    the guardian is ordered to do is no file."""
    text = re.sub(r'//[^\n]*', '', text)
    text = re.sub(r'(?:->add|\bgive)\(\{\{"do".*?\);', '', text, flags=re.S)
    found = set(re.findall(r'\["(\w+)"\](?=(?:\["\w+"\])*\s*=[^=])'
                           r'|\b(?:finding\.value|(?<!_\.)emplace(?:_back)?)\("(\w+)"|\bpush_back\(\{"(\w+)",', text))
    found = {key for pair in found for key in pair if key}
    for object_ in re.finditer(r'\{\s*\{"\w+",', text):
        pairs = [within(e, 0) for e in within(text, object_.start()) if e.startswith('{')]
        if all(len(pair) == 2 for pair in pairs):  # else a table of something else
            found |= {pair[0].strip('"') for pair in pairs if re.fullmatch(r'"\w+"', pair[0]) and pair[1][0] != '['}
    return found


physics, formats, devices = page('physics'), page('formats'), page('devices')
sections = {name: set(re.findall(r'^\.S[hs] "?(\d+(?:\.\d+)?)[. ]', text, re.M))
            for name, text in (('physics', physics), ('devices', devices))}
guarantees = len(re.findall(r'^\.It$', ''.join(re.findall(r'^\.Sh 9\. GUARANTEES$.*?^\.Sh ', devices, re.M | re.S)), re.M))
papers = dict(re.findall(rf'^\.It ({KEY})$\n(.*?)(?=^\.It |^\.El)', physics, re.M | re.S))
defined = set().union(*(equations(b) for b in brackets(physics)), set())
keys = {word for line in re.findall(r'^\..*?\bVa (.*)', formats, re.M)
        for word in re.split(r' (?:Pq|No|Ns)\b', line)[0].replace(',', ' ').split()}
keys |= set(re.findall(r'"(\w+)":', formats))
attributes = set(re.findall(r'^\.It Va (vam:\w+)', formats, re.M))
faults = []


def check(where, text):
    cited = brackets(text)
    faults.extend(f'{where}: {mistake}' for bracket in dict.fromkeys(cited) for mistake in mistakes(bracket))
    plain = re.sub(r'\[[^\[\]]*\]', '', joined(text))
    for words in re.findall(r'(?i)\b(?:physics|devices|formats|vam-(?:physics|devices|formats)\(7\)),? (?:sec[a-z]*[. ]+|§ ?)\d*|§', plain):
        faults.append(f'{where}: "{words}" is to be written [physics §n]')
    for words in re.findall(r'(?i)\b(?:guarantee|promise|slip)s? \d\d?\b', plain):
        faults.append(f'{where}: "{words}" is to be written [devices guarantee n] or [physics §n]')
    for comment in re.findall(r'(?:^[ \t]*//.*\n)+|//.*', text, re.M):
        for words in re.findall(r"\w+ et al|[A-Z][\w']+,? \(?(?:18|19|20)\d\d\b(?!-)", joined(comment)):
            faults.append(f'{where}: "{words}" is to be cited by its key, [RAY21]')
    for name in sorted(set(re.findall(r'\bvam:\w+', text)) - attributes):
        faults.append(f'{where}: the attribute {name} is not defined in vam-formats(7)')


used = cited = ''
for top in ('lib', 'tools', 'tests', 'scripts'):
    for file in sorted((root / top).rglob('*')):
        if not file.is_file() or file.name.startswith('citations.') or '__pycache__' in file.parts:
            continue
        text = file.read_text(errors='replace')
        check(file.relative_to(root), text)
        if top in ('lib', 'tools', 'scripts'):
            used += text
        if top == 'lib':
            cited += joined(text)
        written = set()
        if top in ('lib', 'tools') and file.suffix in ('.cpp', '.hpp') and 'Json' in text:
            written = json_keys(text)
        elif top == 'scripts' and file.name.startswith('vam-'):  # what they print
            written = set(re.findall(r'"(\w+)": ?[%["]', text))
        for key in sorted(written - keys):
            faults.append(f'{file.relative_to(root)}: the key "{key}" is not defined in vam-formats(7)')

for equation in sorted(defined):
    if not re.search(rf'{equation}(?!\d)', cited):
        faults.append(f'man/vam-physics.7: nothing in lib cites [{equation}]')
for paper in sorted(papers):
    if not re.search(rf'(?<!\.It )\b{paper}\b', physics + cited):
        faults.append(f'man/vam-physics.7: nothing cites {paper}')
for name in sorted(attributes - set(re.findall(r'\bvam:\w+', used))):
    faults.append(f'man/vam-formats.7: nothing writes or reads {name}')
for name in ('physics', 'formats', 'devices'):
    for path in re.findall(r'(?:lib|tools|tests|scripts)/[\w/.-]*\w/?', page(name)):
        if not (root / path).exists():
            faults.append(f'man/vam-{name}.7: there is no {path}')
for file in sorted((root / 'man').iterdir()):
    text = ' '.join(file.read_text().split()) if file.suffix in ('.1', '.7') else ''
    for name, numbers in re.findall(r'vam-(physics|devices)(?:\(7\)| 7) ?,(?: No)? section( \d+(?:\.\d+)?|s [\d., and]+)', text):
        faults.extend(f'man/{file.name}: vam-{name}(7) has no section {number}'
                      for number in re.findall(r'\d+(?:\.\d+)?', numbers) if number not in sections[name])
guide = re.sub(r'```diff.*?```', '', (root / 'CONTRIBUTING.md').read_text(), flags=re.S)
for path in re.findall(r'(?:lib|tools|tests|scripts)/[\w/.-]*\w/?(?=[`,. ])', guide):
    if not (root / path).exists():
        faults.append(f'CONTRIBUTING.md: there is no {path}')
for change in re.findall(r'^```diff\n(.*?)^```', (root / 'CONTRIBUTING.md').read_text(), re.M | re.S):
    for name, hunks in re.findall(r'^\+\+\+ b/(\S+)\n(.*?)(?=^--- |\Z)', change, re.M | re.S):
        path = root / name
        there = set(path.read_text().splitlines()) if path.exists() else set()
        lost = {sign: [line[1:] for line in hunks.splitlines() if line[:1] == sign and line[1:] not in there]
                for sign in ' -+'}
        for line in lost[' '] or (lost['-'] and lost['+']):  # it may have been applied
            faults.append(f'CONTRIBUTING.md: a recipe changes "{line}", which is not in {name}')
sources = [f for top in ('lib', 'tools', 'tests') for f in (root / top).rglob('*') if f.suffix in ('.cpp', '.hpp', '.cc')]
names = {f.name for f in sources}
for file in sources:
    for comment in re.findall(r'//.*', file.read_text()):
        for name in re.findall(r'(?<![\w*>-])[\w-]+\.(?:cpp|hpp|cc)\b', comment):
            if name not in names:
                faults.append(f'{file.relative_to(root)}: a comment names {name}, which does not exist')
for folder in re.findall(r'^([\w/]+):', (root / 'lib/layers.txt').read_text(), re.M):
    if not re.search(rf'(?<![\w/]){folder}(?![\w/])', guide):
        faults.append(f'CONTRIBUTING.md: the diagram of the layers lacks {folder}')
for section, key in re.findall(r'^    \{"(\w+)", "(\w+)", at<', used, re.M):
    if not re.search(rf'^\.It Va {section}\.{key}\b', formats, re.M):
        faults.append(f'man/vam-formats.7: the printer file\'s {section}.{key} is missing')
versions = dict(re.findall(r'^    \{"([\w -]+)", (\d+)\},', (root / 'lib/base/text/format_version.hpp').read_text(), re.M))
for kind, number in sorted(versions.items()):
    if not re.search(rf'\b{kind}/{number}\b|^\.It {kind} Ta .* Ta {number}$', formats, re.M):
        faults.append(f'man/vam-formats.7: version {number} of {kind} is missing')
for kind, number in sorted(set(re.findall(r'"(vam-[a-z-]+)/(\d+)\\?"', used + formats))):
    if versions.get(kind) != number:
        faults.append(f'lib/base/text/format_version.hpp: has no version {number} of {kind}, which is written')

print(*faults, sep='\n', end='\n' if faults else '')
sys.exit(bool(faults))
