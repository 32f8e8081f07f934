// On a narrow screen the menu scrolls: its current entry is in sight.

document.querySelector("nav [aria-current]")?.scrollIntoView({ block: "nearest", inline: "center" });
