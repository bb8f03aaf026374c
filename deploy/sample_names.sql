-- 100 000 last names for the quickstart, in alphabetical order, made of parts of real German names: no data of real people, and the
-- same names on every machine. The names that the protocol manual's example shows stand where it shows them: record 22118 is Maier,
-- 22119 Mailänder, 22373 Middelbüscher, 99999 Zupke and 100000 Zwick.
PRAGMA journal_mode = OFF;
BEGIN;

CREATE TEMP TABLE front(part TEXT);
INSERT INTO front VALUES
    ('Acker'), ('Ahl'), ('Alten'), ('Apfel'), ('Asch'), ('Auer'), ('Bach'), ('Bären'), ('Berg'), ('Birken'), ('Blumen'), ('Böhm'),
    ('Brand'), ('Breiten'), ('Brück'), ('Buchen'), ('Burg'), ('Dachs'), ('Dahl'), ('Dorn'), ('Dreyer'), ('Dürr'), ('Eben'), ('Eber'),
    ('Eichen'), ('Eisen'), ('Elsen'), ('Erlen'), ('Eschen'), ('Falken'), ('Feld'), ('Fichten'), ('Fisch'), ('Fuchs'), ('Gärtner'),
    ('Geiß'), ('Gold'), ('Grün'), ('Gruber'), ('Haber'), ('Hammer'), ('Hasel'), ('Heiden'), ('Hirsch'), ('Hoch'), ('Höfer'), ('Holz'),
    ('Hütten'), ('Jäger'), ('Kalten'), ('Kirch'), ('Klee'), ('Köhler'), ('König'), ('Korn'), ('Kraut'), ('Kühn'), ('Lahn'), ('Lang'),
    ('Lauten'), ('Linden'), ('Löwen'), ('Mahl'), ('Mandel'), ('Marien'), ('Mauer'), ('Mayer'), ('Meister'), ('Michel'), ('Mittel'),
    ('Moor'), ('Möller'), ('Morgen'), ('Mühl'), ('Müller'), ('Nacht'), ('Nagel'), ('Neu'), ('Nieder'), ('Nuß'), ('Ober'), ('Oehl'),
    ('Ohlen'), ('Oster'), ('Otten'), ('Pfeiffer'), ('Pflaum'), ('Pohl'), ('Räder'), ('Rauch'), ('Reb'), ('Rhein'), ('Richter'),
    ('Rosen'), ('Rothen'), ('Rüben'), ('Sachsen'), ('Sand'), ('Schäfer'), ('Schilling'), ('Schloß'), ('Schmidt'), ('Schnee'),
    ('Schön'), ('Schröder'), ('Schüßler'), ('Schwarzen'), ('See'), ('Silber'), ('Sommer'), ('Sonnen'), ('Stein'), ('Stern'), ('Süß'),
    ('Tannen'), ('Teich'), ('Thal'), ('Trauben'), ('Uhl'), ('Ulmen'), ('Unter'), ('Vogel'), ('Voß'), ('Wachs'), ('Wagner'), ('Wald'),
    ('Weber'), ('Weiden'), ('Weiß'), ('Wester'), ('Wiesen'), ('Winter'), ('Wolfen'), ('Wörn'), ('Zeller'), ('Ziegel'), ('Zimmer');

CREATE TEMP TABLE back(part TEXT);
INSERT INTO back VALUES
    ('bach'), ('bäcker'), ('bauer'), ('baum'), ('berg'), ('berger'), ('bichler'), ('brecht'), ('brink'), ('bruch'), ('brunner'),
    ('bühl'), ('burger'), ('busch'), ('büscher'), ('dorf'), ('dörfer'), ('egger'), ('feld'), ('felder'), ('fels'), ('furt'), ('gärtner'),
    ('grund'), ('hagen'), ('hammer'), ('hardt'), ('häuser'), ('haus'), ('heim'), ('heimer'), ('hof'), ('höfer'), ('holz'), ('hölzer'),
    ('huber'), ('hütter'), ('kamp'), ('kämper'), ('kirch'), ('köhler'), ('kötter'), ('lechner'), ('lehner'), ('leitner'), ('loh'),
    ('macher'), ('mann'), ('mayr'), ('meier'), ('meyer'), ('moser'), ('mühl'), ('müller'), ('nagel'), ('pfleger'), ('rath'), ('reiter'),
    ('rieder'), ('roth'), ('sänger'), ('schläger'), ('schmied'), ('schneider'), ('schütz'), ('stätter'), ('stein'), ('steiner'),
    ('stock'), ('strauß'), ('thaler'), ('trop'), ('vogt'), ('wald'), ('wasser'), ('weber'), ('weiler'), ('wirth'), ('zweig');

CREATE TEMP TABLE short(name TEXT);
INSERT INTO short VALUES
    ('Bauer'), ('Becker'), ('Braun'), ('Fischer'), ('Frank'), ('Günther'), ('Hahn'), ('Hartmann'), ('Herrmann'), ('Hoffmann'), ('Jung'),
    ('Kaiser'), ('Keller'), ('Klein'), ('Koch'), ('Köhler'), ('König'), ('Krämer'), ('Kraus'), ('Krüger'), ('Lange'), ('Lehmann'),
    ('Mailänder'), ('Majer'), ('Mann'), ('Martin'), ('Mayer'), ('Meier'), ('Meyer'), ('Möller'), ('Müller'), ('Neumann'), ('Peters'),
    ('Richter'), ('Roth'), ('Schäfer'), ('Schmidt'), ('Schmitz'), ('Schneider'), ('Scholz'), ('Schröder'), ('Schulz'), ('Schwarz'),
    ('Vogel'), ('Wagner'), ('Walter'), ('Weber'), ('Weiß'), ('Werner'), ('Winkler'), ('Wolf'), ('Zimmermann');

-- Every name with the key that it is sorted by, and its turn in a draw that is the same everywhere.
CREATE TEMP TABLE pool(name TEXT PRIMARY KEY, key TEXT, turn INTEGER) WITHOUT ROWID;
INSERT OR IGNORE INTO pool(name)
    SELECT name FROM short
    UNION ALL SELECT f.part || b.part FROM front f, back b
    UNION ALL SELECT s.name || '-' || f.part || b.part FROM short s, front f, back b;
UPDATE pool SET key = replace(replace(replace(replace(lower(name), 'ä', 'a'), 'ö', 'o'), 'ü', 'u'), 'ß', 'ss'),
                turn = (unicode(substr(name, 2)) * 7919 + unicode(substr(name, -3)) * 104729 + unicode(substr(name, length(name) / 2)) * 1299709
                        + length(name) * 15485863) * 2654435761 % 4294967296;

CREATE TEMP TABLE chosen(name TEXT, key TEXT);
INSERT INTO chosen VALUES
    ('Maier', 'maier'), ('Mailänder', 'mailander'), ('Middelbüscher', 'middelbuscher'), ('Zupke', 'zupke'), ('Zwick', 'zwick');
INSERT INTO chosen SELECT name, key FROM pool WHERE key < 'maier' ORDER BY turn, name LIMIT 22117;
INSERT INTO chosen SELECT name, key FROM pool WHERE key > 'mailander' AND key < 'middelbuscher' ORDER BY turn, name LIMIT 253;
INSERT INTO chosen SELECT name, key FROM pool WHERE key > 'middelbuscher' AND key < 'zupke' ORDER BY turn, name LIMIT 77625;

CREATE TABLE names(id INTEGER PRIMARY KEY, name TEXT NOT NULL);
INSERT INTO names(name) SELECT name FROM chosen ORDER BY key, name;
COMMIT;
