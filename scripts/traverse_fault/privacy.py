"""What is private on this machine, and texts without it: folders, names of the user and of the machine, addresses of mail."""

import os
import pathlib
import pwd
import re
import socket

# Folders of the root in which people have files. A path in one of them keeps its last name only.
OF_PEOPLE = ("home", "root", "Users", "mnt", "media", "srv", "data", "work", "scratch", "tmp", "var", "run", "net", "nfs", "export",
             "Volumes", "gpfs", "lustre", "project", "projects", "group", "groups")
OF_SYSTEM = {"usr", "lib", "lib64", "lib32", "bin", "sbin", "etc", "proc", "sys", "dev", "boot"}
PART = r"[^\s/\"'`:,;<>|()\[\]{}#\\]+"  # a part of a path without blanks
MAIL = re.compile(r"[\w.+-]+@[\w-]+(\.[\w-]+)+")
WINDOWS = re.compile(r"(?<!\w)([A-Za-z]:|\\)\\([^\\/\n\"'<>|:]+\\)+")
OWNER = re.compile(rf"(?:/home|/Users|[A-Za-z]:\\Users)[/\\]({PART})")
OWN_WORDS = {"folder", "home", "user", "host", "mail", "program", "scratch", "localhost", "traverse", "root", "debian", "ubuntu"}
LONG = 6  # letters of a name that no numbers resemble by chance


def people():
    """The names of the user: of the account, in full, and of who has become root."""
    names = {os.environ.get(name, "") for name in ("USER", "LOGNAME", "SUDO_USER")}
    try:
        account = pwd.getpwuid(os.getuid())
        full = account.pw_gecos.split(",")[0]
        names |= {account.pw_name, full, *full.split()}
    except KeyError:
        pass
    return names


def machines():
    names = {socket.gethostname(), os.uname().nodename, os.environ.get("HOSTNAME", "")}
    return names | {name.split(".")[0] for name in names}


def homes():
    found = {os.environ.get("HOME", "")}
    try:
        found.add(pwd.getpwuid(os.getuid()).pw_dir)
    except KeyError:
        pass
    return found


def last_name(path):
    """A path without its folders; without the name of a person."""
    parts = pathlib.PurePath(path).parts
    return "FOLDER" if len(parts) < 3 or len(parts) == 3 and parts[1] in ("home", "Users") else f"FOLDER/{parts[-1]}"


def is_private_top(name):
    return name not in OF_SYSTEM and not name.startswith(".")


class Privacy:
    """Replaces what is private. vocabulary: words that Traverse itself uses, which remain also if a user has such a name."""

    def __init__(self, vocabulary=()):
        self.common = OWN_WORDS | set(vocabulary)
        self.folders, self.names = {}, {}
        for home in homes():
            self.add_folder(home, "HOME")
        for stand_in, names in (("USER", people()), ("HOST", machines())):
            for name in names:
                self.add_name(name, stand_in)
        tops = {*OF_PEOPLE, *filter(is_private_top, os.listdir("/"))}
        self.anywhere = re.compile(rf"(?:/(?:home|Users)|(?<![\w.~-])/(?:{'|'.join(map(re.escape, tops))}))(?=/)"
                                   rf"(?:/(?:{PART} )*{PART}(?=/))*/(?:{PART})?")

    def add_folder(self, path, stand_in):
        """A folder, or a file, that texts name by other words; what is in a folder "" becomes relative."""
        for one in {str(path), os.path.realpath(path)} if str(path) else ():
            if one.startswith("/") and one != "/" and one.split("/")[1] not in OF_SYSTEM:
                before = "" if one.count("/") > 1 else r"(?<![\w./-])"  # /data may be the end of another path
                self.folders.setdefault(one.rstrip("/"), (re.compile(rf"{before}{re.escape(one.rstrip('/'))}(/|(?![\w-]))"), stand_in))

    def add_name(self, name, stand_in):
        """A name of a person or of a machine, unless it is an ordinary word."""
        name = name.strip()
        if len(name) > 1 and not name.isdigit() and name.lower() not in self.common:
            self.names.setdefault(name, stand_in)

    def learn(self, text):
        """Takes the names of people from the paths in a text, which another machine may have written."""
        for found in OWNER.finditer(text):
            self.add_name(found[1], "USER")

    def clean(self, text):
        """The text without what is private."""
        for folder in sorted(self.folders, key=len, reverse=True):
            if folder in text:
                pattern, stand_in = self.folders[folder]
                text = pattern.sub(lambda found, put=stand_in: put + found[1] if put else "" if found[1] else ".", text)
        text = self.anywhere.sub(lambda found: last_name(found[0]), text)
        text = WINDOWS.sub("FOLDER/", MAIL.sub("MAIL", text))
        for name in sorted(self.names, key=len, reverse=True):
            text = self.of_name(name).sub(self.names[name], text)
        return text

    @staticmethod
    def of_name(name):
        """A name as a word or as a part of one between underscores, in any case."""
        return re.compile(rf"(?<![^\W_]){re.escape(name)}(?![^\W_])", re.IGNORECASE)

    def found_in_text(self, text):
        return self.clean(text) != text

    def found_in_bytes(self, data):
        """Whether a folder, or a name that no numbers resemble by chance, is in any bytes."""
        text = data.decode("latin-1")  # each byte a letter
        patterns = [(folder, pattern) for folder, (pattern, _) in self.folders.items() if len(folder) >= LONG]
        patterns += [(name, self.of_name(name)) for name in self.names if len(name) >= LONG]
        return any(re.search(re.escape(word.encode(errors="surrogateescape")), data, re.IGNORECASE) and
                   pattern.search(text) for word, pattern in patterns)
