// The words of the page, in English as they stand everywhere and in German by this table, and the tour.

const german = {
  "Open files": "Dateien öffnen", "Start from": "Beginnen mit", "Undo": "Rückgängig", "Redo": "Wiederholen", "Tour": "Rundgang", "Language": "Sprache",
  "The page is being unpacked ...": "Die Seite wird entpackt ...", "Point at the mesh to read its color.": "Zeigen Sie auf das Netz, um seine Farbe abzulesen.",
  "Dragging moves": "Ziehen bewegt", "view": "Ansicht", "light": "Licht", "lamp": "Lampe", "color": "Farbe", "travel": "Farblauf", "gloss": "Glanz",
  "First view": "Erste Ansicht", "Full screen": "Ganzer Bildschirm", "by": "um", "units of L* or chroma, or degrees of hue": "Einheiten von L* oder Buntheit, oder Grad des Farbtons",
  "Face, flop and travel": "Aufsicht, Flop und Farblauf",
  "Drag the ends of the arrow, or focus one and use the arrow keys (with Shift in larger steps).": "Ziehen Sie an den Enden des Pfeils, oder wählen Sie eines aus und nehmen Sie die Pfeiltasten (mit Umschalt in größeren Schritten).",
  "Average of the whole paint": "Mittel des ganzen Lacks", "Color by aspecular angle": "Farbe nach dem Winkel zum Glanz", "Light": "Licht", "Exposure": "Belichtung", "stops": "Blenden",
  "turned by": "gedreht um", "Ground": "Boden",
  "as the environment shows it, laid below the mesh, with the shadow of the mesh there and on itself.": "wie ihn die Umgebung zeigt, unter das Netz gelegt, mit dem Schatten des Netzes dort und auf sich selbst.",
  "Sparkle": "Funkeln", "of the flakes that the paint states, in lamps and bright spots, where an eye sees single ones.": "der Flakes, die der Lack nennt, im Licht von Lampen und hellen Stellen, wo ein Auge einzelne sieht.",
  "Lamp": "Lampe", "azimuth": "Azimut", "elevation": "Höhe", "brightness": "Helligkeit", "Rings at": "Ringe bei", ", and the highlight": " und das Glanzlicht",
  "Parts": "Teile", "Second paint:": "Zweiter Lack:", "Make this paint the second": "Diesen Lack zum zweiten machen", "none yet": "noch keiner", "The part that was clicked": "Der angeklickte Teil",
  "paint": "Lack", "second paint": "zweiter Lack", "glass": "Glas", "rubber": "Gummi", "chrome": "Chrom", "hidden": "verborgen", "by its name": "nach dem Namen", "not recognized": "nicht erkannt", "unnamed part": "Teil ohne Namen", "Close": "Schließen",
  "Compare": "Vergleichen", "Compare with": "Vergleichen mit", "as": "als", "one car with a border": "ein Auto mit Grenze", "two cars": "zwei Autos", "four cars": "vier Autos",
  "paints between": "Lacke dazwischen", "Gradient to it": "Verlauf dorthin", "nothing": "nichts", "the paint it began with": "dem Lack, mit dem er begann",
  "Variations": "Abwandlungen", "of": "von", "face": "Aufsicht", "flop": "Flop", "step": "Schritt", "as it is": "wie er ist",
  "Nearest paints of the library": "Nächste Lacke der Bibliothek", "CIE 1976": "CIE 1976", "CIEDE2000": "CIEDE2000", "start": "beginnen", "Start from this paint": "Mit diesem Lack beginnen", "Compare with it": "Damit vergleichen",
  "Library": "Bibliothek", "Search": "Suchen", "class": "Art", "any": "jede", "solid": "Uni", "metallic": "Metallic", "pearl": "Perl", "interference": "Interferenz", "unknown": "unbekannt", "in order of": "geordnet nach",
  "the library's order": "Folge der Bibliothek", "Filters": "Filter", "to": "bis", "The library in L*a*b*": "Die Bibliothek in L*a*b*", "at": "bei",
  "Pictures": "Bilder", "Open, drop or paste pictures anywhere on the page. They stay on this computer; saved sessions hold them.": "Öffnen Sie Bilder, oder ziehen oder fügen Sie sie irgendwo auf der Seite ein. Sie bleiben auf diesem Rechner; gespeicherte Sitzungen enthalten sie.",
  "New board": "Neue Tafel", "Dropper": "Pipette", "move the picture": "das Bild bewegen", "radius": "Radius", "zoom": "Vergrößerung", "keep a flop that is lighter than the face": "einen Flop behalten, der heller als die Aufsicht ist",
  "Swap face and flop": "Aufsicht und Flop tauschen", "Remove this picture": "Dieses Bild entfernen", "Palette": "Palette", "Keep this paint": "Diesen Lack behalten", "Remove": "Entfernen",
  "Figures": "Zahlen", "Handing over": "Weitergeben", "Name": "Name", "Code": "Code", "Notes, for the card, the session and paint XML": "Notizen, für die Karte, die Sitzung und Paint-XML",
  "Save paint XML": "Lack-XML sichern", "Save with lobes": "Mit Keulen sichern", "Save CSV": "CSV sichern", "Save CxF": "CxF sichern", "Save session": "Sitzung sichern", "Save picture": "Bild sichern", "Save a turn as film": "Eine Drehung als Film sichern",
  "Print a card": "Karte drucken", "Copy link": "Verweis kopieren", "The same by commands": "Dasselbe als Befehle", "Copy the commands": "Befehle kopieren",
  "Paints (XML, CSV, CxF, XLSX, CGATS, QTX ...), meshes (OBJ, glTF), light (HDR), pictures and sessions; they can be dropped on the page as well":
    "Lacke (XML, CSV, CxF, XLSX, CGATS, QTX ...), Netze (OBJ, glTF), Licht (HDR), Bilder und Sitzungen; man kann sie auch auf die Seite ziehen",
  "Undo (Ctrl+Z)": "Rückgängig (Strg+Z)", "Redo (Ctrl+Y)": "Wiederholen (Strg+Y)", "Picture": "Bild",
  "The mesh in the paint. Arrow keys do what dragging does, and plus and minus come closer.": "Das Netz im Lack. Pfeiltasten tun, was Ziehen tut; Plus und Minus ändern den Abstand.",
  "Border between the paint and the one it is compared with": "Grenze zwischen dem Lack und dem, mit dem er verglichen wird", "Paint": "Lack", "Change the color under the cross": "Die Farbe unter dem Kreuz ändern",
  "Plane of a* and b*": "Ebene von a* und b*", "Lightness of face and flop": "Helligkeit von Aufsicht und Flop", "L*, a* and b* against the aspecular angle": "L*, a* und b* über dem Winkel zum Glanz", "Turn of the light": "Drehung des Lichts",
  "Turn of the light in degrees": "Drehung des Lichts in Grad", "name or code": "Name oder Code",
  "Paints of the library as points in L*a*b*. Drag or use the arrow keys to turn them; click on a point to choose its paint.": "Lacke der Bibliothek als Punkte in L*a*b*. Ziehen oder Pfeiltasten drehen sie; ein Klick auf einen Punkt wählt seinen Lack.",
  "The same by paint-pick": "Dasselbe mit paint-pick", "lightness": "Helligkeit", "chroma": "Buntheit", "hue": "Farbton", "keep what the readings have beside the curve": "behalten, was die Messwerte neben der Kurve haben",
  "brushed": "gebürstet", "sideways": "quer", "upward": "aufwärts", "0 for none": "0 für keine", "Brushed surface": "Gebürstete Oberfläche",
  "flake size": "Flakegröße", "coverage": "Bedeckung", "Flakes": "Flakes", "Take away": "Wegnehmen", "The paint has no flakes.": "Der Lack hat keine Flakes.", "The paint states its flakes.": "Der Lack nennt seine Flakes.",
  "Flakes are assumed, as usual in class {}.": "Flakes sind angenommen, wie in der Art {} üblich.",
  "lighter": "heller", "darker": "dunkler", "hue -": "Farbton -", "hue +": "Farbton +", "less chroma": "weniger Buntheit", "more chroma": "mehr Buntheit",
  "flop index": "Flopindex", "chroma index": "Buntheitsindex", "hue shift index": "Farbtonindex", "lightness of the face": "Helligkeit der Aufsicht", "chroma of the face": "Buntheit der Aufsicht",
  "Dragging goes around the mesh; arrow keys do so too. A click on a part lets you choose what it wears.": "Ziehen und Pfeiltasten führen um das Netz. Ein Klick auf einen Teil lässt wählen, was er trägt.",
  "Dragging turns the light around the mesh; arrow keys do so too.": "Ziehen und Pfeiltasten drehen das Licht um das Netz.",
  "The highlight of the lamp goes where you drag it; arrow keys move the lamp.": "Das Glanzlicht der Lampe geht, wohin Sie es ziehen; Pfeiltasten bewegen die Lampe.",
  "Drag the cross over the picture, or move it by arrow keys; its buttons change the color there.": "Ziehen Sie das Kreuz über das Bild, oder nehmen Sie die Pfeiltasten; seine Knöpfe ändern dort die Farbe.",
  "The color stops changing where you drag to; arrow keys change the travel.": "Die Farbe hört dort auf sich zu ändern, wohin Sie ziehen; Pfeiltasten ändern den Farblauf.",
  "The highlight falls to half its brightness where you drag to; arrow keys change the gloss.": "Das Glanzlicht fällt dort auf die Hälfte, wohin Sie ziehen; Pfeiltasten ändern den Glanz.",
  "The camera and the light of a traced view stay as they are.": "Kamera und Licht einer verfolgten Ansicht bleiben, wie sie sind.", "This part does not wear the paint.": "Dieser Teil trägt den Lack nicht.",
  "This board is empty: add pictures, or drop or paste them.": "Diese Tafel ist leer: öffnen Sie Bilder, oder ziehen oder fügen Sie sie ein.",
  "New here? The tour shows the page in two minutes.": "Neu hier? Der Rundgang zeigt die Seite in zwei Minuten.", "Next": "Weiter", "Skip": "Überspringen", "Done": "Fertig",
  "Readings are taken at geometries such as": "Messwerte stehen bei Geometrien wie",
  // Sentences with values, in their order.
  "This place is turned away from {}.": "Diese Stelle ist abgewandt: {}.", "the lamp": "die Lampe", "the brightest light": "das hellste Licht", "gray": "grau", "chroma {}, hue {}°": "Buntheit {}, Farbton {}°",
  "{}° from the mirror direction of {}: L* {}, a* {}, b* {} ({})": "{}° vom Spiegelwinkel ({}): L* {}, a* {}, b* {} ({})",
  "A print by {} shows the {} {} (CIEDE2000) off.": "Ein Druck mit {} verfehlt die Farbe ({}) um {} (CIEDE2000).", "take L* {}, a* {}, b* {}": "L* {}, a* {}, b* {} nehmen",
  "History": "Bisherige Schritte", ", as it was": ", wie er war", "Flags": "Vermerke", "measured by": "gemessen nach", "Traced views": "Verfolgte Ansichten",
  "Drag a reading, or focus it and use the up and down keys. The broken line is what the lobes show.":
    "Ziehen Sie an einem Messwert, oder wählen Sie ihn aus und nehmen Sie die Tasten nach oben und unten. Die gestrichelte Linie ist, was die Keulen zeigen.",
  "This paint is designed: face, flop and travel make its curve. The broken line is what the lobes show.":
    "Dieser Lack ist entworfen: Aufsicht, Flop und Farblauf machen seine Kurve. Die gestrichelte Linie ist, was die Keulen zeigen.",
  "{}: L* {}, a* {}, b* {}; contrast stands for {} gloss units": "{}: L* {}, a* {}, b* {}; der Kontrast steht für {} Glanzeinheiten",
  "Point at the picture with a dropper, or focus it and use the arrow keys.": "Zeigen Sie mit einer Pipette auf das Bild, oder wählen Sie es aus und nehmen Sie die Pfeiltasten.",
  "This view was traced: shadows, the floor and the light that parts send to each other are in it. Its camera and its light stay as they are.":
    "Diese Ansicht wurde verfolgt: Schatten, der Boden und das Licht, das Teile einander senden, sind darin. Ihre Kamera und ihr Licht bleiben, wie sie sind.",
  "This view was traced: shadows and the light that parts send to each other are in it. Its camera and its light stay as they are.":
    "Diese Ansicht wurde verfolgt: Schatten und das Licht, das Teile einander senden, sind darin. Ihre Kamera und ihr Licht bleiben, wie sie sind.",
  "Parts that wore one paint wear several now: bounced light is doubtful.": "Teile, die einen Lack trugen, tragen nun mehrere: zurückgeworfenes Licht ist zweifelhaft.",
  "Bounced light was traced in other paints and is scaled to this one: off by {} (CIEDE2000, at most in 95 of 100 points).":
    "Zurückgeworfenes Licht wurde in anderen Lacken verfolgt und ist auf diesen skaliert: es weicht um {} ab (CIEDE2000, höchstens, in 95 von 100 Punkten).",
  "That is doubtful: trace the view again in this paint, by render-osmesa --aov transport.": "Das ist zweifelhaft: verfolgen Sie die Ansicht neu in diesem Lack, mit render-osmesa --aov transport.",
  "A paint with a coat took the place of one without it, or the other way round: toward grazing the picture is that of the paint that was traced.":
    "Ein Lack mit Klarlack steht an der Stelle von einem ohne, oder umgekehrt: zum streifenden Blick hin zeigt das Bild den Lack, der verfolgt wurde.",
  "{} cannot be read: it is a folder, or too large.": "{} kann nicht gelesen werden: ein Ordner, oder zu groß.", "This page does not have the light of the link: {}.": "Diese Seite hat das Licht des Verweises nicht: {}.",
  "The screen shows the {} {} (CIEDE2000) off.": "Der Bildschirm verfehlt die Farbe ({}) um {} (CIEDE2000).", "take a* {}, b* {}": "a* {}, b* {} nehmen", "none": "keine",
  "{} parts: told by their names are {}; {} not recognized, which wear the paint.": "{} Teile: nach ihren Namen {}; {} nicht erkannt, sie tragen den Lack.",
  "The design lies outside the library: its nearest paint differs by more than 10 on average.": "Der Entwurf liegt außerhalb der Bibliothek: sein nächster Lack weicht im Mittel um mehr als 10 ab.",
  "Its hue turns in another way than that of its nearest paint (off-radial).": "Sein Farbton dreht sich anders als der seines nächsten Lacks.",
  "From face to flop its hue turns by {}°, and that of the nearest paint, whose way is dashed in the wheel, by {}°.": "Von der Aufsicht zum Flop dreht sich sein Farbton um {}°, der des nächsten Lacks, dessen Weg im Rad gestrichelt ist, um {}°.",
  "{} of {} paints": "{} von {} Lacken", "The design, with the cross, has L* {}, a* {}, b* {} there, among {} paints.": "Der Entwurf, mit dem Kreuz, hat dort L* {}, a* {}, b* {}, unter {} Lacken.",
  "{} paints between {} and {} are in the palette.": "{} Lacke zwischen {} und {} sind in der Palette.", "miss the readings by": "verfehlen die Messwerte um", "{} on average, {} at most (CIEDE2000)": "{} im Mittel, {} höchstens (CIEDE2000)",
  "does not apply": "trifft nicht zu", "Lost outside the working space": "Verloren außerhalb des Arbeitsfarbraums", "This cannot be done:": "Das geht nicht:", "Clipped:": "Beschnitten:", "Lobes": "Keulen", "GU": "GU", "45as15": "45as15",
  "{}: the session is open.": "{}: die Sitzung ist geöffnet.", "{} is being read ...": "{} wird gelesen ...", "{}: {} triangles.": "{}: {} Dreiecke.", "{}: the light was filtered in {} s.": "{}: das Licht wurde in {} s gefiltert.",
  "{} is being filtered: {} %": "{} wird gefiltert: {} %", "{} of its {} paints are in the palette.": "{} seiner {} Lacke sind in der Palette.", "{} is opened as {}.": "{} ist geöffnet als {}.",
  "The lobes miss the readings of {} by {} on average, {} at most (CIEDE2000).": "Die Keulen verfehlen die Messwerte von {} um {} im Mittel, {} höchstens (CIEDE2000).", "{} is the basis of this page.": "{} ist die Basis dieser Seite.",
  "{}: the lights of this page are filtered for the lobes of the basis {}. Make a page of the other one by paint-studio --basis.": "{}: die Lichter dieser Seite sind für die Keulen der Basis {} gefiltert. Machen Sie mit paint-studio --basis eine Seite für die andere.",
  "The film: {} %": "Der Film: {} %", "The film is saved.": "Der Film ist gesichert.",
  // The notes of words.
  "The aspecular angle, in degrees, at which the color has reached the flop and stops changing.": "Der Winkel zum Glanz in Grad, bei dem die Farbe den Flop erreicht hat und sich nicht mehr ändert.",
  "Gloss units: what a gloss meter reads. Black glass has about 100.": "Glanzeinheiten: was ein Glanzmesser zeigt. Schwarzes Glas hat etwa 100.",
  "Highlights of different widths, whose sum is the paint: few of them are fitted to the readings.": "Glanzlichter verschiedener Breite, deren Summe der Lack ist: wenige von ihnen werden den Messwerten angepasst.",
  "Geometries such as 45as15: light comes from 45°, and the instrument looks 15° beside the mirror direction.": "Geometrien wie 45as15: das Licht kommt unter 45°, und das Gerät schaut 15° neben den Spiegelwinkel.",
  // The tour.
  "a* and b*": "a* und b*", "{}* of the {}": "{}*, {}", "{} of the {}": "{}, {}", "{} at {}": "{} bei {}", "{} of {}": "{} aus {}", "lowest": "untere Grenze:", "highest": "obere Grenze:", "the part": "der Teil",
  "red": "Rot", "yellow": "Gelb", "green": "Grün", "cyan": "Cyan", "blue": "Blau", "magenta": "Magenta",
  "width of the highlight {}": "Breite des Glanzlichts {}", "What {} wears": "Was {} trägt", "Start from {}": "Mit {} beginnen", "Remove {} from the palette": "{} aus der Palette nehmen",
  "Board {}": "Tafel {}", "Picture {}. Arrow keys move the dropper, with Shift by ten pixels.": "Bild {}. Pfeiltasten bewegen die Pipette, mit Umschalt um zehn Pixel.",
  "sum {}: {}": "Summe {}: {}", "Light: {}.": "Licht: {}.", "Travel {}°.": "Farblauf {}°.", "Gloss {}.": "Glanz {}.", "{} GU at {}°": "{} GU bei {}°",
  "The commands": "Die Befehle", "The link": "Der Verweis", "{}: copied.": "{}: kopiert.", "This browser refuses to copy. {}: {}": "Dieser Browser lässt nicht kopieren. {}: {}",
  "{} does not pass the filter of the list.": "{} geht nicht durch den Filter der Liste.", "This library has no paint named {}.": "Diese Bibliothek hat keinen Lack mit dem Namen {}.",
  "The file has the code {} of the nearest paint, {}.": "Die Datei hat den Code {} des nächsten Lacks, {}.", "The nearest paint has no code, so that the file has none of it.": "Der nächste Lack hat keinen Code, die Datei also keinen von ihm.",
  "Choose a paint to compare with: the gradient leads to it.": "Wählen Sie einen Lack zum Vergleich: zu ihm führt der Verlauf.",
  "The address of this page is cut: copy the whole link.": "Die Adresse dieser Seite ist abgeschnitten: kopieren Sie den ganzen Verweis.",
  "The address of this page holds no paint.": "Die Adresse dieser Seite enthält keinen Lack.", "This link does not say how the paint is seen.": "Dieser Verweis sagt nicht, wie man den Lack sieht.",
  "This file is no session of a page.": "Diese Datei ist keine Sitzung einer Seite.", "This file is no session of a page with this library.": "Diese Datei ist keine Sitzung einer Seite mit dieser Bibliothek.",
  'A page with another library made this: it starts from "{}".': 'Eine Seite mit einer anderen Bibliothek hat dies geschrieben: es beginnt mit "{}".',
  "The browser does not keep {}: save the session as a file.": "Der Browser behält {} nicht: sichern Sie die Sitzung als Datei.", "pictures of this size": "Bilder dieser Größe", "this session": "diese Sitzung",
  "{} was made smaller: its sides have at most {} pixels here.": "{} wurde verkleinert: Seiten haben hier höchstens {} Pixel.", "{} is no picture that this browser reads.": "{} ist kein Bild, das dieser Browser liest.",
  "The pictures of this session are damaged.": "Die Bilder dieser Sitzung sind beschädigt.", "Every pixel below the dropper is transparent: move it.": "Jedes Pixel unter der Pipette ist durchsichtig: bewegen Sie sie.",
  "{}: the filter stopped: {}": "{}: der Filter brach ab: {}", "This browser makes no WebM films.": "Dieser Browser macht keine WebM-Filme.",
  "The camera of a traced view stays as it is: choose a light.": "Die Kamera einer verfolgten Ansicht bleibt, wie sie ist: wählen Sie ein Licht.",
  "This browser has no WebGL 2, with which the picture is drawn.": "Dieser Browser hat kein WebGL 2, mit dem das Bild gezeichnet wird.",
  "The graphics of this computer cannot draw float pictures, which the page needs.": "Die Grafik dieses Rechners zeichnet keine Bilder aus Gleitkommazahlen, wie sie die Seite braucht.",
  "The graphics of this computer cannot hold the weights of this basis.": "Die Grafik dieses Rechners fasst die Gewichte dieser Basis nicht.",
  "This browser shows no part of a page on the full screen.": "Dieser Browser zeigt keinen Teil einer Seite auf dem ganzen Bildschirm.",
  "The graphics of this computer were reset: the picture comes back when they do. Nothing is lost.": "Die Grafik dieses Rechners wurde zurückgesetzt: mit ihr kommt das Bild zurück. Nichts ist verloren.",
  "The graphics are back.": "Die Grafik ist wieder da.", "There is no room for the layers of this picture.": "Für die Schichten dieses Bildes ist kein Platz.",
  "This browser cannot decompress the data of the page: it takes a newer one.": "Dieser Browser kann die Daten der Seite nicht entpacken: sie braucht einen neueren.",
  "This is the paint on a car. Drag to go around it, and turn the wheel with Ctrl to come closer. Wherever you point, the page tells the color that the paint has there.":
    "Dies ist der Lack auf einem Auto. Ziehen führt darum herum, und das Rad mit Strg ändert den Abstand. Wohin Sie auch zeigen: die Seite nennt die Farbe, die der Lack dort hat.",
  "The arrow leads from the face, the color near the highlight, to the flop, the color far from it. Drag its ends to change them; the column beside it has their lightness.":
    "Der Pfeil führt von der Aufsicht, der Farbe nahe dem Glanzlicht, zum Flop, der Farbe weit davon. Ziehen Sie an seinen Enden; die Säule daneben hat die Helligkeit.",
  "Travel says how far from the highlight the color reaches the flop, and gloss how sharp the highlight is.": "Der Farblauf sagt, wie weit vom Glanzlicht die Farbe den Flop erreicht, und der Glanz, wie scharf das Glanzlicht ist.",
  "Dragging on the car can move other things as well: the light, a lamp by its highlight, travel and gloss on the surface itself.": "Ziehen auf dem Auto kann auch anderes bewegen: das Licht, eine Lampe an ihrem Glanzlicht, Farblauf und Glanz auf der Fläche selbst.",
  "Choose the light here. Lights and cars of your own are opened as files.": "Wählen Sie hier das Licht. Eigene Lichter und Autos öffnen Sie als Dateien.",
  "These paints of the library are nearest to the design. A click puts one beside it on the car.": "Diese Lacke der Bibliothek sind dem Entwurf am nächsten. Ein Klick stellt einen auf dem Auto daneben.",
  "Files of instruments, cars and lights come in by this button, or dropped anywhere. At the end of the panels the design goes out: as files, a card, a film or a link.":
    "Dateien von Messgeräten, Autos und Lichter kommen durch diesen Knopf herein, oder irgendwo abgelegt. Am Ende der Tafeln geht der Entwurf hinaus: als Dateien, Karte, Film oder Verweis.",
};

const tourSteps = [
  ["#stage-place", "This is the paint on a car. Drag to go around it, and turn the wheel with Ctrl to come closer. Wherever you point, the page tells the color that the paint has there."],
  ["#wheel-row", "The arrow leads from the face, the color near the highlight, to the flop, the color far from it. Drag its ends to change them; the column beside it has their lightness."],
  ["#numbers", "Travel says how far from the highlight the color reaches the flop, and gloss how sharp the highlight is."],
  ["#drag-kinds", "Dragging on the car can move other things as well: the light, a lamp by its highlight, travel and gloss on the surface itself."],
  ["#environment", "Choose the light here. Lights and cars of your own are opened as files."],
  ["#nearest", "These paints of the library are nearest to the design. A click puts one beside it on the car."],
  ["#open-files", "Files of instruments, cars and lights come in by this button, or dropped anywhere. At the end of the panels the design goes out: as files, a card, a film or a link."],
];

// The meanings of words that only this field has.
const notes = {
  travel: "The aspecular angle, in degrees, at which the color has reached the flop and stops changing.",
  GU: "Gloss units: what a gloss meter reads. Black glass has about 100.",
  Lobes: "Highlights of different widths, whose sum is the paint: few of them are fitted to the readings.",
  "45as15": "Geometries such as 45as15: light comes from 45°, and the instrument looks 15° beside the mirror direction.",
};

// A value that the browser keeps for the page; nothing where it refuses.
function kept(name, value) {
  try {
    if (value !== undefined) localStorage.setItem(name, value);
    return localStorage.getItem(name);
  } catch {
    return null;
  }
}

let language = "en";
const words = (text) => (language === "de" ? german[text] ?? text : text);

// A sentence with values, by the table: told`${x} of ${y} paints`.
const told = (sentence, ...values) => words(sentence.join("{}")).split("{}").map((part, i) => part + (values[i] ?? "")).join("");

// A word with its note, which shows while the pointer or the focus is on it.
const noted = (name) => made("abbr", { tabindex: 0, "data-note": words(notes[name]), "aria-label": `${words(name)}: ${words(notes[name])}`, words: name });

// Brings the texts that stand in the page into the language of the browser, or the one that was chosen.
function translatePage() {
  language = kept("paint-studio language") ?? (navigator.language.startsWith("de") ? "de" : "en");
  document.documentElement.lang = language;
  for (const option of document.querySelectorAll("option:not([value])")) option.value = option.textContent;
  const texts = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
  while (texts.nextNode()) {
    const node = texts.currentNode, text = node.data.trim();
    if (german[text] && node.parentElement.tagName !== "SCRIPT") node.data = node.data.replace(text, words(text));
  }
  for (const name of ["title", "aria-label", "placeholder"])
    for (const element of document.querySelectorAll(`[${name}]`)) element.setAttribute(name, words(element.getAttribute(name)));
  const list = document.getElementById("language");
  list.value = language;
  list.addEventListener("change", () => {
    kept("paint-studio language", list.value);
    location.reload();
  });
}

class Tour {
  constructor(app) {
    this.box = document.getElementById("tour");
    document.getElementById("begin-tour").addEventListener("click", () => this.go(0));
    this.box.addEventListener("keydown", (event) => { if (event.key === "Escape") this.go(-1); });
    if (!kept("paint-studio toured")) app.say(words("New here? The tour shows the page in two minutes."));
  }
  go(number) {
    document.querySelector(".toured")?.classList.remove("toured");
    this.box.hidden = !(number in tourSteps);
    kept("paint-studio toured", "yes");
    if (this.box.hidden) return document.getElementById("begin-tour").focus();
    const [selector, text] = tourSteps[number], place = document.querySelector(selector), last = number === tourSteps.length - 1;
    (place.closest("label") ?? place).classList.add("toured");
    place.scrollIntoView({ block: "nearest" });
    const next = made("button", { type: "button", words: last ? "Done" : "Next", onclick: () => this.go(number + 1) });
    this.box.replaceChildren(made("p", { words: text }), made("div", { class: "row" }, [made("span", { text: `${number + 1} / ${tourSteps.length}` }), next, made("button", { type: "button", words: "Skip", onclick: () => this.go(-1) })]));
    next.focus({ preventScroll: true });
  }
}

if (typeof module !== "undefined") module.exports = { german, tourSteps, notes };
